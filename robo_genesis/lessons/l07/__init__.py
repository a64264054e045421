"""L07: a scene that can be tested."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    FRANKA_MJCF="robo_genesis.sim.arm.franka",
    describe="robo_genesis.sim.arm.joints",
    fixed_parts="robo_genesis.sim.visual_shape",
    build_world="robo_genesis.sim.bodies.contacts",
    record_world="robo_genesis.sim.bodies.contacts",
    mujoco_contacts="robo_genesis.sim.mujoco.contacts",
    look="robo_genesis.sim.camera.views",
    segment_number="robo_genesis.sim.camera.views",
    refused="robo_genesis.core.exercises",
    read_shape="robo_genesis.sim.visual_shape",
)
