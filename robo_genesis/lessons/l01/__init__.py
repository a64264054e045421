"""L01: is this machine ready?"""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    read_model="robo_genesis.sim.bodies.rigid_bodies",
    run_drop="robo_genesis.sim.bodies.rigid_bodies",
    run_python="robo_genesis.sim.fresh_process",
    floor="robo_genesis.sim.visual_shape",
    read_shape="robo_genesis.sim.visual_shape",
)
