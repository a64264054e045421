"""What arrays of a reach cannot be, whatever metrics and checks they give."""

from collections.abc import Iterator, Sequence

from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05.run import ReachCase, SolveCase
from robo_genesis.sim.plausibility.joints import (
    driven_run,
    never_stepped,
    poses,
    start_and_limits,
)
from robo_genesis.sim.plausibility.rules import Breach, apart, refuse, times


def require_possible_runs(run: Experiment) -> None:
    """Require of each run the mechanics of the robot, or of assigned postures.

    Raises:
        BundleRefused: `stamps`, `start`, `law`, `pose` or `motion`.
    """
    for name, case in run.cases.items():
        rules = assigned if isinstance(case, SolveCase) else driven
        refuse(f"arrays/{name}.npz", rules(run.traces[name], case, run.links))


def driven(trace: Trace, case: ReachCase, links: Sequence[str]) -> Iterator[Breach]:
    """Yield what no run has that commands the posture in its own record."""
    yield from driven_run(trace, case.commanding(trace.target[0]), links)


def assigned(trace: Trace, case: SolveCase, links: Sequence[str]) -> Iterator[Breach]:
    """Yield what no record of assigned answers has."""
    yield from times(trace, case.steps, case.dt)
    yield from start_and_limits(trace, case.start)
    yield from apart("start", "q [rad or m]", trace.q[1:], trace.target, 1e-6)
    yield from never_stepped(trace)
    yield from poses(trace, links)
