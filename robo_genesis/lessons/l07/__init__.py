"""L07, a robot turns one joint."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    FRANKA_MJCF="robo_genesis.sim.arm.franka",
    describe="robo_genesis.sim.arm.joints",
    run_case="robo_genesis.sim.arm.joint_control",
    build_world="robo_genesis.sim.bodies.contacts",
    record_world="robo_genesis.sim.bodies.contacts",
    mujoco_contacts="robo_genesis.sim.mujoco.contacts",
    read_shape="robo_genesis.sim.visual_shape",
)
