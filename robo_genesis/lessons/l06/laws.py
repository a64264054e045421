"""What environments have in common by the mechanics of the robot."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.franka import per_joint
from robo_genesis.sim.arm.laws import driven_run, model_joints
from robo_genesis.sim.laws import kept

MEASURES = False

# A hand that turns sideways pushes its fingers, which hold each other. That force, up to 0.34 N
# here, is not in the law.
NET_FORCE = per_joint(*(1e-2,) * 7, 0.6, 0.6)
"""Tolerance of an internal force [N·m or N]."""


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of its own robot."""
    yield from kept("the joint map", model_joints(run.joints))
    for name, world in run.cases.items():
        trace = run.traces[name]
        case = world.commanding(trace.target)
        yield from kept(name, driven_run(trace, case, run.links, NET_FORCE, world.load))
