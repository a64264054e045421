"""Every check of L04 passes on sound runs, and at least one spoiled run fails it."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import (
    case,
    copied,
    failed,
    frames,
    joints,
    metric,
    put,
    reading,
    shift,
    trace,
)
from lessons.experiments import checks_of, each, run_with

from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.checks import laws_of_motion

K = spec.ENTRY
GRID_G2 = study_spec.CASE_POINTS["G2"].name
IMPLICIT_G2 = "MuJoCo_implicitfast_G2_substeps_2"


def overshoot(name, value):
    """Return a change of a run's highest sample: it passes the target by `value` [rad]."""

    def change(run):
        highest = run.traces[name].q[:, K].argmax(), K
        return trace(name, q=put(highest, run.traces[name].target[0, K] + value))(run)

    return change


def lifted(name, by):
    """Return a change of all samples of a run after the first: higher by `by` [rad]."""
    return trace(name, q=lambda q: np.vstack([q[:1], q[1:] + by * (np.arange(9) == K)]))


def as_theory(run):
    """Let the large step follow the ideal curve."""
    response = study.ideal(run, "G1").response(run.traces["G1"].t)
    ideal = run.traces["G1_hold"].q[:, K] + spec.STEP * response
    return trace("G1", q=put((slice(None), K), ideal))(run)


def moving_at_the_end(run):
    moving = {name: replace(m, final_velocity=1.0) for name, m in run.metrics.items()}
    return replace(run, accepted=moving)


SPOILERS = {
    "mapping": [
        joints(types=("SPHERICAL",) * 9),
        joints(dofs_idx_local=np.arange(9) // 2),
    ],
    "baseline_approaches": [metric("baseline", final_error=0.25)],
    "stamps": [case("P1", steps=119)],
    "same_start": [
        trace("G2", start_qd=put(1, 1e-6)),
        trace("G3", link_pos=put((0, 1, 2), 0.6)),
    ],
    "one_factor": [case("G3", kp=put(0, 4501.0)), case("G2", seed=1)],
    "which_joint": [copied("P2", "P1"), trace("P1", q=shift((-1, 0), 0.1))],
    "assigned_only": [
        trace("assigned", qd=put((3, K), 1e-3)),
        copied("assigned", "P1"),
    ],
    "posture": [frames()],
    "claimed_orders": [overshoot("G3", 0.1)],
    "clipped_start": [
        trace("G1", start_control_force=put(K, 80.0)),
        copied("G3", "G2"),
        trace("G2", control_force=np.abs),
    ],
    "gravity_support": [reading(study.GROUP, "gravity_G2", 30.0), moving_at_the_end],
    "ends_at_rest": [metric("G1", final_error=0.011)],
    "same_beginning": [trace("G2_longer", qd=put((3, 0), 9.0))],
    "same_metrics": [metric("G2_longer", settling_time=1.5)],
    "same_model": [reading(study.GROUP, "inertia_Genesis", 1.01)],
    "implicit_term": [reading(study.GROUP, "mass_KV_300", 2.5)],
    "clipped_before_parting": [as_theory],
    "small_step_unsaturated": [trace("G2_hold", control_force=put((7, K), 87.0))],
    "theory_small_step": [lifted("G1_small", 0.001), as_theory],
    "stepped_model": [overshoot("G2", 0.1)],
    "model_predicts": [overshoot("G1", 0.01), lifted("G2_small", 0.0001)],
    "stable_engines": [copied("G2", "MuJoCo_Euler_G2_substeps_2")],
    "first_step": [copied("G3", "G2")],
    "convergence": [overshoot("G2_substeps_4", 0.07)],
    "one_limit": [overshoot("G2_substeps_50", 0.0415)],
    "second_engine_order": [copied(IMPLICIT_G2, "MuJoCo_implicitfast_G1_substeps_2")],
    "order_at_finer_step": [copied("G3_substeps_20", "G2_substeps_20")],
    "grid_matches_cases": [
        trace(GRID_G2, q=put((60, K), 0.0)),
        metric(GRID_G2, rise_time=None),
    ],
}


@pytest.mark.parametrize(("check", "spoil"), each(SPOILERS))
def test_a_spoiled_run_fails_its_check(experiments, monkeypatch, check, spoil):
    run = spoil(run_with(experiments, check))
    cases = {name: run.cases.get(name, of) for name, of in spec.CASES.items()}
    monkeypatch.setattr(spec, "CASES", cases)
    assert failed(run) == {check}


def test_each_check_has_a_spoiled_run_and_no_sound_run_fails(experiments):
    assert {*SPOILERS, "study_factors"} == checks_of(experiments)
    assert [failed(run) for run in experiments.values()] == [set()] * len(experiments)


def test_a_study_case_with_a_second_factor_fails(experiments, monkeypatch):
    second = replace(study_spec.STEP_CASES["G1_small"], seed=1)
    monkeypatch.setitem(study_spec.STEP_CASES, "G1_small", second)
    assert "study_factors" in failed(experiments["formula"])


@pytest.mark.parametrize(
    ("name", "spoil"),
    [
        ("assigned", trace("assigned", q=put((3, 1), 0.1))),
        (IMPLICIT_G2, copied(IMPLICIT_G2, "G3")),
    ],
)
def test_a_run_that_breaks_its_laws_is_named(experiments, name, spoil):
    run = next(run for run in experiments.values() if name in run.traces)
    broken = [found.label for found in laws_of_motion(spoil(run)) if not found.passed]
    assert [label.partition(":")[0] for label in broken] == [name]
