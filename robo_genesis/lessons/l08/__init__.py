"""L08: a scripted expert."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    FRANKA_MJCF="robo_genesis.sim.arm.franka",
    build="robo_genesis.sim.arm.picking",
    describe="robo_genesis.sim.arm.joints",
    picking="robo_genesis.sim.arm.picking",
    set_link_mass="robo_genesis.sim.arm.batch",
    refused="robo_genesis.core.exercises",
    run_python="robo_genesis.sim.fresh_process",
    last_value="robo_genesis.sim.fresh_process",
    grippers="robo_genesis.sim.bodies",
    mujoco_grippers="robo_genesis.sim.mujoco.grippers",
    fixed_parts="robo_genesis.sim.visual_shape",
    read_shape="robo_genesis.sim.visual_shape",
)
