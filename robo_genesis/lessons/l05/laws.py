"""What reaches have in common by the mechanics of the robot."""

from collections.abc import Iterator
from itertools import chain

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l05 import spec, study
from robo_genesis.lessons.l05.run import SolveCase
from robo_genesis.sim.arm.laws import assigned_postures, driven_run, model_joints
from robo_genesis.sim.laws import broken, kept

MEASURES = False

FEWEST = 0.25
"""Share of the answers of a reach map that are accepted at least; the maps have 0.54 and 0.62."""


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of the driven or assigned robot."""
    yield from kept("the joint map", model_joints(run.joints))
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, SolveCase):
            laws = assigned_postures(trace, case.start, run.links, run.traces.values())
            if name in spec.REACH_MAP:
                laws = chain(laws, own_targets(trace, case))
        else:
            laws = driven_run(trace, case.commanding(trace.target[0]), run.links)
        yield from kept(name, laws)


def own_targets(trace: Trace, case: SolveCase) -> Iterator[Finding]:
    """Yield a reach map whose answers hardly ever bring the hand to their targets."""
    share = float(study.answers(trace, case)["accepted"].mean())
    if share < FEWEST:
        yield broken("pose", "share of answers at their targets", share, f"at least {FEWEST}")
