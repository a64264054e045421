"""What reaches have in common by the mechanics of the robot."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l05.run import SolveCase
from robo_genesis.sim.arm.laws import assigned_postures, driven_run, model_joints
from robo_genesis.sim.laws import kept

MEASURES = False


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of the driven or assigned robot."""
    yield from kept("the joint map", model_joints(run.joints))
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, SolveCase):
            broken = assigned_postures(trace, case.start, run.links)
        else:
            broken = driven_run(trace, case.commanding(trace.target[0]), run.links)
        yield from kept(name, broken)
