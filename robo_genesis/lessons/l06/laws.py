"""What environments have in common by the mechanics of the robot."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.franka import EFFORT_LIMIT, per_joint
from robo_genesis.sim.arm.laws import driven_run, model_joints
from robo_genesis.sim.laws import kept

MEASURES = False

# A hand that turns sideways pushes its fingers, which hold each other. That force is not in the
# law. It is up to 0.34 N here, and 2.3 N with 20 times the limits, because the hand turns faster.
NET_FORCE = per_joint(*(1e-2,) * 7, 0.6, 0.6)
"""Tolerance of an internal force with the usual limits [N·m or N]."""


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of its own robot."""
    yield from kept("the joint map", model_joints(run.joints))
    for name, world in run.cases.items():
        trace = run.traces[name]
        case = world.commanding(trace.target)
        room = NET_FORCE * world.effort_limit / EFFORT_LIMIT
        yield from kept(name, driven_run(trace, case, run.links, room, world.load))
