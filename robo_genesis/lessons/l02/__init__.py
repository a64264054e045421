"""L02: scenes, entities, and the simulation life cycle."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    read_model="robo_genesis.sim.bodies.rigid_bodies",
    run_drop="robo_genesis.sim.bodies.rigid_bodies",
    refused="robo_genesis.core.exercises",
    require_frame="robo_genesis.sim.camera.frames",
    floor="robo_genesis.sim.visual_shape",
    read_shape="robo_genesis.sim.visual_shape",
)
