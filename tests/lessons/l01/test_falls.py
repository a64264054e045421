"""L01's sphere: metrics with known answers, a run that fails each check."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import body_run, make_drop

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l01 import machine, spec, text
from robo_genesis.lessons.l01.metrics import fall_metrics
from robo_genesis.lessons.l01.pages import LECTURE

CASE = spec.BASELINE
TIMES = {f"{start}_{part}": 0.5 for start in machine.STARTS for part in machine.PARTS}
READINGS = {"model": spec.EXPECTED_MODEL, machine.TIMES: TIMES}
READINGS[machine.DOCTOR] = dict.fromkeys(machine.STEPS, 1)


def test_a_stepped_fall_has_no_error_and_a_continuous_one_is_behind():
    found = fall_metrics(make_drop(CASE), CASE)
    assert found.final_height == pytest.approx(0.298895, abs=1e-6)
    assert found.asked_height == pytest.approx(
        0.5 - 9.81 * CASE.h**2 * 30 * 31 / 2, abs=1e-6
    )
    assert found.formula_error < spec.FORMULA_TOLERANCE
    assert found.school_gap == pytest.approx(9.81 * CASE.h * 0.2 / 2, abs=1e-6)
    t = np.arange(CASE.steps + 1) * CASE.dt
    continuous = body_run(t, z=CASE.height - 9.81 * t**2 / 2, vz=-9.81 * t)
    found = fall_metrics(continuous, CASE)
    assert found.formula_error == pytest.approx(9.81 * CASE.h * 0.2 / 2, abs=1e-6)
    assert found.school_gap == pytest.approx(0, abs=1e-6)


def experiment(frames, case=CASE, **changed) -> Experiment:
    traces = {"baseline": make_drop(case)}
    return Experiment(LECTURE, traces, [spec.LINK], READINGS | changed, frames, True)


@pytest.mark.parametrize(
    ("case", "changed", "failed"),
    [
        (CASE, {}, set()),
        (CASE, {"model": spec.EXPECTED_MODEL | {"geoms": 2}}, {"structure"}),
        (replace(CASE, height=0.6), {}, {"start", "free_fall"}),
        (replace(CASE, steps=19), {}, {"stamps"}),
        (replace(CASE, gravity=9.82), {}, {"computed_height", "free_fall"}),
        (CASE, {machine.DOCTOR: READINGS[machine.DOCTOR] | {"render": 0}}, {"doctor"}),
        (CASE, {machine.TIMES: dict.fromkeys(TIMES, 900.0)}, set()),
    ],
)
def test_each_check_fails_on_its_own_fault_and_none_judges_a_time(
    frames, case, changed, failed
):
    outcomes = experiment(frames, case=case, **changed).outcomes()
    assert {check.name for check in outcomes if not check.passed} == failed


def test_the_text_says_what_was_measured(frames):
    for gravity, surprising in ((9.81, False), (9.82, True)):
        said = text.conclusion(experiment(frames, replace(CASE, gravity=gravity)))
        assert ("more than rounding" in said) == surprising
