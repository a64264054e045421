"""What runs of a driven robot have in common by its mechanics."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l04 import study_spec
from robo_genesis.sim.arm.laws import assigned_run, driven_run
from robo_genesis.sim.laws import kept

MEASURES = False


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links and control forces are those of the driven or assigned robot."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        assigned = name == study_spec.ASSIGNED
        laws = (
            assigned_run(trace, run.links, case.model)
            if assigned
            else driven_run(trace, case, run.links)
        )
        yield from kept(name, laws)
