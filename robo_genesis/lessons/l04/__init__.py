"""L04, robot models, degrees of freedom, and joint control."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    CAMERA="robo_genesis.core.scene",
    DT="robo_genesis.core.scene",
    SUBSTEPS="robo_genesis.core.scene",
    run_batch="robo_genesis.sim.arm.batch",
    FRANKA_MJCF="robo_genesis.sim.arm.franka",
    JOINT_NAMES="robo_genesis.sim.arm.franka",
    assign_path="robo_genesis.sim.arm.joint_control",
    describe="robo_genesis.sim.arm.joints",
    differences="robo_genesis.sim.arm.joint_control",
    refused="robo_genesis.core.exercises",
    reset="robo_genesis.sim.arm.joint_control",
    run_case="robo_genesis.sim.arm.joint_control",
    validate="robo_genesis.sim.arm.joint_control",
    resolve_joints="robo_genesis.sim.arm.joints",
    mujoco_joints="robo_genesis.sim.mujoco.joints",
    read_shape="robo_genesis.sim.visual_shape",
)
