"""Named checks of a box that lands."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding, at_most, model_counts, sample_times, within
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06 import spec
from robo_genesis.sim import end_state


def structure(run: Experiment) -> Iterator[Finding]:
    return model_counts(run.readings["model"], spec.EXPECTED_MODEL)


def times(run: Experiment) -> Iterator[Finding]:
    return sample_times(run.cases, run.traces)


def lands(run: Experiment) -> Iterator[Finding]:
    end = run.metrics["baseline"]
    height = spec.BASELINE.size / 2
    yield within("baseline.final_height_m", end.final_height, height, spec.HEIGHT_TOLERANCE)
    yield at_most("baseline.final_speed_m_s", end.final_speed, spec.AT_REST)


def posture(run: Experiment) -> Iterator[Finding]:
    return end_state.findings(run.rendered, run.frames, run.traces["baseline"].link_pos)


CHECKS = (structure, times, lands, posture)
