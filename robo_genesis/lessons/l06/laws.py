"""What environments have in common by the mechanics of the robot."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.franka import per_joint
from robo_genesis.sim.arm.laws import commanded, driven_run
from robo_genesis.sim.laws import kept

MEASURES = False

# A hand that turns sideways pushes its fingers, which hold each other. That force, up to 0.34 N
# here, is not in the law.
NET_FORCE = per_joint(*(1e-2,) * 7, 0.6, 0.6)
"""Tolerance of an internal force [N·m or N]."""


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and, without a load, velocities are those of its own robot."""
    for name, world in run.cases.items():
        trace = run.traces[name]
        what = trace, world.commanding(trace.target), run.links
        broken = commanded(*what) if world.load else driven_run(*what, NET_FORCE)
        yield from kept(name, broken)
