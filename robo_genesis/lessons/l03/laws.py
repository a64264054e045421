"""What runs of landings, slides and bounces have in common by the laws of motion."""

from collections.abc import Iterator
from itertools import chain

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l03 import study_spec
from robo_genesis.sim.bodies.laws import repeated_steps, reported_depth
from robo_genesis.sim.laws import kept

MEASURES = False


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """Each reported depth is that of the body's shape, and MuJoCo repeats most steps of Genesis."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        second = name in study_spec.IN_MUJOCO
        steps = () if second else repeated_steps(trace, case)
        yield from kept(name, chain(reported_depth(trace, case), steps))
