"""L06: many worlds at once."""

from robo_genesis.core.declaration import on_demand

__getattr__ = on_demand(
    __name__,
    LESSON="pages",
    target_parts="pages",
    refused="robo_genesis.core.exercises",
    set_link_mass="robo_genesis.sim.arm.batch",
    FRANKA_MJCF="robo_genesis.sim.arm.franka",
    describe="robo_genesis.sim.arm.joints",
    read_shape="robo_genesis.sim.visual_shape",
)
