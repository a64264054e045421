"""Named checks of L01: a sphere falls as computed, and the doctor passes every step."""

from robo_genesis.core.checks import Findings, at_most, equal
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.bodies.checks import structure
from robo_genesis.sim.bodies.laws import free_fall
from robo_genesis.sim.common_checks import posture, stamps, start

from . import machine, spec


def computed_height(run: Experiment) -> Findings:
    """At every sample the height is the one computed beforehand, to within float32."""
    error = run.metrics["baseline"].formula_error
    yield at_most("baseline.formula_error_m", error, spec.FORMULA_TOLERANCE)


def doctor(run: Experiment) -> Findings:
    """Every step of the doctor passes in a process of its own."""
    for step in machine.STEPS:
        yield equal(step, run.readings[machine.DOCTOR][step], 1)


CHECKS = (structure, start, stamps, computed_height, free_fall, posture)
