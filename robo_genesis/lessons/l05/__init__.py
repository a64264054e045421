"""L05, forward and inverse kinematics, and cameras as sensors."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    DT="robo_genesis.core.scene",
    SUBSTEPS="robo_genesis.core.scene",
    FRANKA_MJCF="robo_genesis.sim.arm.franka",
    refused="robo_genesis.core.exercises",
    describe="robo_genesis.sim.arm.joints",
    reset="robo_genesis.sim.arm.joint_control",
    kinematics="robo_genesis.sim.arm.kinematics",
    view_record="robo_genesis.sim.camera.record",
    look="robo_genesis.sim.camera.views",
    segment_number="robo_genesis.sim.camera.views",
    fixed_parts="robo_genesis.sim.visual_shape",
    read_shape="robo_genesis.sim.visual_shape",
    ask="run",
    reach="run",
    solve_all="run",
)
