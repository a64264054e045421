"""L03: rigid-body physics and stable simulation."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    SURFACE_SIZE="robo_genesis.sim.bodies.contacts",
    TOP="robo_genesis.sim.bodies.contacts",
    build_world="robo_genesis.sim.bodies.contacts",
    record_world="robo_genesis.sim.bodies.contacts",
    time_constant="robo_genesis.sim.bodies.contacts",
    read_model="robo_genesis.sim.bodies.rigid_bodies",
    mujoco_contacts="robo_genesis.sim.mujoco.contacts",
    read_shape="robo_genesis.sim.visual_shape",
    slab="robo_genesis.sim.visual_shape",
)
