"""What arrays of an environment cannot be, whatever metrics and checks they give."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06.run import World
from robo_genesis.sim.franka import per_joint
from robo_genesis.sim.plausibility.joints import (
    LAW,
    control_law,
    dynamics,
    poses,
    start_and_limits,
)
from robo_genesis.sim.plausibility.rules import Breach, apart, refuse, times

NET_FORCE = per_joint(*(1e-2,) * 7, 0.6, 0.6)
"""Tolerance of an internal force [N·m or N]. A hand that turns sideways pushes its fingers, which
hold each other; that force, up to 0.34 N here, the rule does not know."""


def require_possible_runs(run: Experiment) -> None:
    """Require of each run the mechanics of a robot with the gains of its world.

    Raises:
        BundleRefused: `stamps`, `start`, `law`, `pose` or `motion`.
    """
    for name, world in run.cases.items():
        refuse(f"arrays/{name}.npz", driven(run.traces[name], world, run.links))


def driven(trace: Trace, world: World, links: Sequence[str]) -> Iterator[Breach]:
    """Yield what no run has with the commands in its own record.

    The mechanics are those of the robot alone, so a run with a load in the hand is not compared
    with them.
    """
    case = world.commanding(trace.target)
    first = replace(case, q_target=trace.target[0])
    yield from times(trace, case.steps, case.dt)
    yield from start_and_limits(trace, case)
    start = control_law(first, trace.q[0], trace.start_qd)
    yield from apart("law", "start_control_force [N·m or N]", trace.start_control_force, start, LAW)
    law = control_law(case, trace.q[1:], trace.qd)
    yield from apart("law", "control_force [N·m or N]", trace.control_force, law, LAW)
    yield from poses(trace, links)
    if not world.load:
        yield from dynamics(trace, case, NET_FORCE)
