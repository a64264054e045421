"""Named checks of a joint that turns; the docstring of each is its claim."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding, at_most, below, model_counts
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l07 import spec
from robo_genesis.sim.arm.franka import MODEL_COUNTS
from robo_genesis.sim.arm.laws import driven_run
from robo_genesis.sim.common_checks import stamps
from robo_genesis.sim.laws import kept


def structure(run: Experiment) -> Iterator[Finding]:
    """The robot has the links, joints and DOFs of its model file."""
    return model_counts(run.readings["model"], MODEL_COUNTS)


def arrives(run: Experiment) -> Iterator[Finding]:
    """Each run ends near its target, and half of KP turns the joint more slowly."""
    for name, of in run.metrics.items():
        yield at_most(f"{name}.final_error_rad", of.final_error, spec.ARRIVED)
    slower, faster = (run.metrics[name].peak_speed for name in ("kp_halved", "baseline"))
    yield below("kp_halved.peak_speed_rad_s", slower, faster)


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of the driven robot."""
    for name, case in run.cases.items():
        yield from kept(name, driven_run(run.traces[name], case, run.links))


CHECKS = (structure, stamps, arrives, laws_of_motion)
