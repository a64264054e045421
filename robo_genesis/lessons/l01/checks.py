"""Named checks of L01: a sphere falls as computed, and the doctor passes every step."""

from collections.abc import Iterator

from robo_genesis.core.check_spec import START_TOLERANCE
from robo_genesis.core.checks import Finding, at_most, equal, model_counts, sample_times, within
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l01 import machine, spec
from robo_genesis.sim import end_state


def structure(run: Experiment) -> Iterator[Finding]:
    return model_counts(run.readings["model"], spec.EXPECTED_MODEL)


def start(run: Experiment) -> Iterator[Finding]:
    trace = run.traces["baseline"]
    height = float(trace.link_pos[0, 0, 2])
    yield within("baseline.start_height_m", height, spec.BASELINE.height, START_TOLERANCE)
    yield equal("baseline.start_velocity_m_s", float(abs(trace.link_vel[0]).max()), 0.0)


def stamps(run: Experiment) -> Iterator[Finding]:
    return sample_times(run.cases, run.traces)


def computed_height(run: Experiment) -> Iterator[Finding]:
    error = run.metrics["baseline"].formula_error
    yield at_most("baseline.formula_error_m", error, spec.FORMULA_TOLERANCE)


def posture(run: Experiment) -> Iterator[Finding]:
    return end_state.findings(run.rendered, run.frames, run.traces["baseline"].link_pos)


def doctor(run: Experiment) -> Iterator[Finding]:
    for step in machine.STEPS:
        yield equal(step, run.readings[machine.DOCTOR][step], 1)


CHECKS = (structure, start, stamps, computed_height, posture)
