"""Checks and sentences of the studies, with MuJoCo in the place of both engines."""

import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core.scene import DT, JOINT_NAMES, Q_START
from robo_genesis.lessons.l04 import (
    engine_comparison,
    spec,
    study,
    study_checks,
    study_plots,
    study_spec,
    theory_text,
)
from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.lessons.l04.theory import IdealJoint, Parting
from robo_genesis.sim import mujoco_joints

K = JOINT_NAMES.index(spec.STEPPED_JOINT)


@pytest.fixture
def measured(study_runs):
    return study_runs


def raised(trace, overshoot):
    """Return a run whose highest sample of the stepped joint passes its target by `overshoot`."""
    q = np.array(trace.q)
    q[q[:, K].argmax(), K] = trace.target[0, K] + overshoot
    return replace(trace, q=q)


def outcomes(run):
    return {check.name: check for check in study_checks.run_checks(run)}


def failed(run):
    return [name for name, check in outcomes(run).items() if not check.passed]


def spoiled(run, **changes):
    return replace(run, traces=dict(run.traces) | changes)


def test_every_check_passes_on_runs_that_are_in_order(measured):
    assert [(c.name, c.detail) for c in study_checks.run_checks(measured) if not c.passed] == []
    assert list(outcomes(measured)) == [check.__name__ for check in study_checks.CHECKS]


def test_another_inertia_or_gravity_is_not_the_same_model(measured):
    one = replace(measured, inertia={"Genesis": 1.582, "MuJoCo": 1.077})
    assert "same_model" in failed(one)
    assert "inertia: Genesis 1.5820" in outcomes(one)["same_model"].detail
    other = replace(measured, gravity_at_start={"Genesis": 22.57, "MuJoCo": 21.0})
    assert failed(other) == ["same_model"]


def test_a_run_with_another_target_is_no_study_of_one_factor(measured):
    assert "study_factors" in failed(spoiled(measured, G1_small=measured.traces["G1"]))


@pytest.mark.parametrize("where", ["start_control_force", "control_force"])
def test_one_clipped_effort_is_no_small_step(measured, where):
    trace = measured.traces["G2_small"]
    effort = np.array(getattr(trace, where))
    effort[..., K].flat[0] = -87.0
    run = spoiled(measured, G2_small=replace(trace, **{where: effort}))
    assert failed(run) == ["small_step_unsaturated"]


def test_a_small_step_off_theory_fails(measured):
    trace = measured.traces["G1_small"]
    overshoot = (study_spec.SMALL_STEP_TOLERANCE + 0.2) * study_spec.SMALL_STEP
    run = spoiled(measured, G1_small=raised(trace, overshoot))
    assert failed(run) == ["theory_small_step"]


def test_theory_must_fit_the_small_step_better_than_the_large_one(measured):
    ideal, hold = measured.ideal("G1"), measured.traces["G1_hold"]
    trace = measured.traces["G1"]
    q = np.array(trace.q)
    q[:, K] = hold.q[:, K] + spec.STEP * ideal.response(trace.t)
    assert "theory_small_step" in failed(spoiled(measured, G1=replace(trace, q=q)))


def test_support_that_is_not_gravitys_fails(measured):
    run = replace(measured, gravity=dict(measured.gravity) | {"G2": 30.0})
    assert failed(run) == ["gravity_support"]


def test_cases_that_still_move_support_nothing(measured):
    moving = {
        name: replace(trace, qd=trace.qd + 1.0)
        for name, trace in measured.traces.items()
        if name in spec.CASES
    }
    assert "gravity_support" in failed(spoiled(measured, **moving))


@pytest.mark.parametrize("n", [4, 50])
def test_an_overshoot_that_rises_with_refinement_is_no_convergence(measured, n):
    name = study.run_name("Genesis", "G2", n)
    run = spoiled(measured, **{name: raised(measured.traces[name], 0.07)})
    assert "convergence" in failed(run)


def test_engines_that_stay_apart_have_no_one_limit(measured):
    name = study.run_name("Genesis", "G2", 50)
    run = spoiled(measured, **{name: raised(measured.traces[name], 0.0245)})
    assert failed(run) == []
    run = spoiled(measured, **{name: raised(measured.traces[name], 0.0415)})
    assert "one_limit" in failed(run)


@pytest.mark.parametrize("integrator", study_spec.SECOND_INTEGRATORS)
def test_an_ordering_that_the_second_engine_breaks_fails(measured, integrator):
    g1, g2 = (study.run_name(integrator, case, spec.G1.substeps) for case in ("G1", "G2"))
    run = spoiled(measured, **{g1: measured.traces[g2], g2: measured.traces[g1]})
    assert "second_engine_order" in failed(run)
    assert f"{integrator}: overshoot" in outcomes(run)["second_engine_order"].detail


@pytest.mark.parametrize("name", ["G2", "G1_hold", "G2_substeps_10"])
def test_a_missing_run_fails_by_name(measured, name):
    run = replace(measured, traces={k: v for k, v in measured.traces.items() if k != name})
    assert failed(run)
    assert any(f"'{name}'" in check.detail for check in outcomes(run).values())


PARTED = Parting(time=0.03, apart=0.12, clipped=2, efforts=3)
UNDER = IdealJoint(1.077, 101.0, 3500.0)


@pytest.mark.parametrize(
    ("found", "says", "not_said"),
    [
        (PARTED, "at 0.03 s, and is at most 0.1200 rad apart", "not the reason"),
        (PARTED, "Clipped efforts up to there: 2 of 3.", "stays within"),
        (replace(PARTED, clipped=0), "saturation is not the reason. Look", "no gain could"),
        (replace(PARTED, time=None, apart=0.004), "stays within 0.01 rad", "clipped"),
    ],
)
def test_the_parting_is_told_as_it_was_found(found, says, not_said):
    text = theory_text.parting_sentence("G1", UNDER, found, 0.01)
    assert text.startswith("G1 (ζ = 0.82, underdamped)")
    assert says in text
    assert not_said not in text


@pytest.mark.parametrize(
    ("small", "large", "says"),
    [
        (0.12, 0.30, "The large step's is not."),
        (0.12, 0.11, "one number can agree by accident"),
        (0.20, 0.11, "Even the small step is off by more than the declared 3.0 %"),
    ],
)
def test_step_sizes_are_held_against_theory(small, large, says):
    text = theory_text.step_size_sentence("G2", 0.106, small, large, 0.03)
    assert "overshoots by 10.6 % of its step" in text
    assert says in text


@pytest.mark.parametrize(
    ("zeta", "word"), [(0.8, "underdamped"), (1.0, "critically damped"), (1.7, "overdamped")]
)
def test_regimes_are_named(zeta, word):
    assert theory_text.damping_word(zeta) == word


@pytest.mark.parametrize(
    ("effort", "velocity", "says", "not_said"),
    [
        (21.5, 0.0, "what a balance of the two would look like", "does not explain"),
        (30.0, 0.0, "gravity alone does not explain the error", "would look like"),
        (21.5, 0.5, "Still moving at the last sample: G1.", "Not proved"),
    ],
)
def test_gravity_is_held_against_kp_times_error(measured, effort, velocity, says, not_said):
    m = replace(measured.measure("G1"), final_error=0.0062, final_velocity=velocity)
    (row,) = theory_text.gravity_rows({"G1": 3500.0}, {"G1": m}, {"G1": effort})
    assert row["KP × final error"] == "21.70 N·m"
    assert row["gravity, engine"] == f"{effort:.2f} N·m"
    text = " ".join(theory_text.gravity_sentences({"G1": 3500.0}, {"G1": m}, {"G1": effort}))
    assert says in text
    assert not_said not in text


@pytest.mark.parametrize(
    ("names", "text"), [(["G1"], "G1"), (["G1", "G2"], "G1 and G2"), (list("abc"), "a, b and c")]
)
def test_names_are_listed(names, text):
    assert theory_text.listed(names) == text


@pytest.mark.parametrize(
    ("fine", "says"),
    [(0.0210, "mostly one of numerical method"), (0.0400, "does not bring them together")],
)
def test_convergence_is_told_from_the_spread(fine, says):
    overshoot = {
        "Genesis": {2: 0.0447, 50: fine},
        "implicitfast": {2: 0.0212, 50: 0.0195},
        "Euler": {2: 0.0193, 50: 0.0193},
    }
    told = engine_comparison.convergence_sentences(overshoot, 2)
    assert (
        f"Genesis: from 2 to 50 substeps the overshoot changes from 0.0447 rad to {fine:.4f} rad."
        in told
    )
    assert told[2].endswith("the overshoot does not change measurably.")
    assert says in told[-1]


def test_the_first_step_tells_engines_whose_kv_acts_while_clipped(measured):
    assert [row["case"] for row in engine_comparison.first_step_rows(measured)] == [
        "G1",
        "G2",
        "G3",
    ]
    text = engine_comparison.first_step_sentence(measured)
    assert "They move alike in Genesis, MuJoCo implicitfast and MuJoCo Euler" in text
    assert "They differ" not in text
    slower = replace(measured.traces["G3"], qd=measured.traces["G3"].qd * 0.5)
    text = engine_comparison.first_step_sentence(spoiled(measured, G3=slower))
    assert "They differ in Genesis: there KV acts although the effort is clipped." in text


def test_the_joint_alone_is_the_equation_by_hand(measured):
    case = study_spec.COMPARED["G1"]
    h, effort = case.dt / case.substeps, measured.traces["G1"].start_control_force[measured.entry]
    net = effort - measured.gravity_at_start["Genesis"]
    damping = measured.passive_damping
    for term in (0.0, 100.0):
        mass = measured.inertia["Genesis"] + h * (damping + term)
        after_one = h * net / mass
        expected = after_one + h * (net - damping * after_one) / mass
        assert engine_comparison.alone(measured, "G1", term) == pytest.approx(expected)
    assert engine_comparison.alone(measured, "G1", 100.0) < engine_comparison.alone(
        measured, "G1", 0
    )


def test_a_first_step_that_was_not_clipped_isolates_nothing(measured):
    free = measured.traces["G3"]
    free = replace(free, start_control_force=free.start_control_force * 0.5)
    text = engine_comparison.first_step_sentence(spoiled(measured, G3=free))
    assert "do not isolate the integrator" in text
    assert "alike" not in text


def test_relations_are_shown_for_every_engine(measured):
    rows = engine_comparison.relation_rows(measured)
    assert len(rows) == len(spec.RELATIONS)
    for row in rows:
        for label in engine_comparison.ENGINE_LABELS.values():
            assert re.match(r"held: .+ → .+", row[label])
    assert f"All {len(spec.RELATIONS)} orderings" in engine_comparison.survival_sentence(measured)


def test_a_relation_that_breaks_is_said(measured):
    g1, g2 = (study.run_name("Euler", case, spec.G1.substeps) for case in ("G1", "G2"))
    run = spoiled(measured, **{g1: measured.traces[g2], g2: measured.traces[g1]})
    text = engine_comparison.survival_sentence(run)
    assert "overshoot higher in G2 than in G1 (MuJoCo Euler: broken)" in text
    assert "All" not in text


def test_rows_of_the_tables_are_the_measured_values(measured):
    rows = engine_comparison.convergence_rows(measured)
    assert [row["substeps"] for row in rows] == list(study_spec.SUBSTEPS_STUDIED)
    assert [row["Genesis"] for row in rows] == [
        "0.0600 rad",
        "0.0500 rad",
        "0.0400 rad",
        "0.0300 rad",
        "0.0250 rad",
        "0.0230 rad",
    ]
    assert [row["case"] for row in theory_text.ideal_rows(measured)] == ["G1", "G2", "G3"]
    sizes = theory_text.step_size_rows(measured)
    assert sizes[1]["overshoot, ideal"] == theory_text.share_text(measured.ideal("G2").overshoot)


def test_sentences_of_the_page_are_one_for_each_case(measured):
    assert len(theory_text.parting_sentences(measured)) == len(study_spec.COMPARED)
    assert len(theory_text.step_size_sentences(measured)) == len(study_spec.SMALL_STEPPED)


def test_chatter_is_counted_for_each_joint(measured):
    traces = {
        name: measured.traces[study.run_name(name, "G2", 2)]
        for name in study_spec.SECOND_INTEGRATORS
    }
    inertia, _ = mujoco_joints.at_rest(spec.G2, Q_START)
    ratio = DT / 2 * (spec.G2.kv + 1) / inertia
    text = engine_comparison.explicit_sentence(JOINT_NAMES, ratio, traces)
    assert "above two for joint1, joint5, joint6 and joint7" in text
    assert "with implicitfast no joint" in text
    assert re.search(r"with Euler .*joint7", text)
    rows = engine_comparison.explicit_rows(JOINT_NAMES, ratio, traces)
    euler = step_metrics(traces["Euler"], K)
    assert rows[K]["clipped, Euler"] == f"{euler.saturation_samples} samples"


def test_no_joint_above_two_is_said(measured):
    text = engine_comparison.explicit_sentence(JOINT_NAMES, np.zeros(9), {})
    assert text.startswith("h (KV + d) / I is above two for no joint.")


def drawn(ax):
    return {line.get_label(): np.asarray(line.get_ydata()) for line in ax.get_lines()}


def test_figures_draw_what_they_are_given():
    t, curve = np.arange(3) * 0.1, np.array([0.0, 0.5, 1.0])
    axes = Figure().subplots(1, 2)
    names = ("G1", "G2")
    study_plots.beside_ideal(
        axes, t, dict.fromkeys(names, curve), dict.fromkeys(names, curve / 2), 1.0, 0.2
    )
    assert [ax.get_title("left") for ax in axes] == list(names)
    assert (drawn(axes[1])["measured"] == curve).all()
    assert (drawn(axes[1])["ideal joint"] == curve / 2).all()
    axes = Figure().subplots(1, 2)
    shares = {name: {"ideal joint": curve, "+0.005 rad": curve / 3} for name in names}
    study_plots.step_sizes(axes, t, shares, 0.2)
    assert (drawn(axes[0])["+0.005 rad"] == curve / 3).all()
    ax = Figure().subplots()
    study_plots.convergence(ax, {"Genesis": {0.01: 0.05, 0.005: 0.04}}, 0.005)
    assert drawn(ax)["Genesis"].tolist() == [0.05, 0.04]
    assert ax.get_xscale() == "log"
