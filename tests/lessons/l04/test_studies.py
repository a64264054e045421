"""Checks and sentences of the studies, with MuJoCo in the place of both engines."""

import re
from dataclasses import replace

import numpy as np
import pytest
from lessons.l04.conftest import own_checks, raised
from matplotlib.figure import Figure

from robo_genesis.core.checks import evaluate
from robo_genesis.core.scene import DT
from robo_genesis.lessons.l04 import (
    engine_comparison,
    lecture_text,
    spec,
    study,
    study_plots,
    study_spec,
    theory_text,
)  # fmt: skip
from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.lessons.l04.theory import IdealJoint, Parting
from robo_genesis.sim.arm.franka import JOINT_NAMES, Q_START
from robo_genesis.sim.mujoco import joints as mujoco_joints

K = spec.ENTRY


def failed(run):
    outcomes = evaluate(own_checks(), run)
    return {check.name: check.detail for check in outcomes if not check.passed}


def spoiled(run, **changes):
    return replace(run, traces=dict(run.traces) | changes)


def with_readings(run, **changes):
    of_joint = run.readings[study.GROUP] | changes
    return replace(run, readings={**run.readings, study.GROUP: of_joint})


def clipped(run, where):
    trace = run.traces["G2_small"]
    effort = np.array(getattr(trace, where))
    effort[..., K].flat[0] = -87.0
    return spoiled(run, G2_small=replace(trace, **{where: effort}))


def off_theory(run):
    q = np.array(run.traces["G1_small"].q)
    q[20, K] += (study_spec.SMALL_STEP_TOLERANCE + 0.2) * study_spec.SMALL_STEP
    return spoiled(run, G1_small=replace(run.traces["G1_small"], q=q))


def as_theory(run):
    """The large step follows the ideal curve."""
    trace, hold = run.traces["G1"], run.traces["G1_hold"]
    q = np.array(trace.q)
    q[:, K] = hold.q[:, K] + spec.STEP * study.ideal(run, "G1").response(trace.t)
    return spoiled(run, G1=replace(trace, q=q))


def moving(run):
    moved = {name: replace(run.traces[name], qd=run.traces[name].qd + 1.0) for name in spec.CASES}
    return spoiled(run, **moved)


def with_overshoot(run, name, overshoot):
    return spoiled(run, **{name: raised(run.traces[name], overshoot)})


def with_cases_swapped(run, integrator):
    g1, g2 = (study.run_name(integrator, case, spec.G1.substeps) for case in ("G1", "G2"))
    return spoiled(run, **{g1: run.traces[g2], g2: run.traces[g1]})


def without(run, name):
    return replace(run, traces={k: v for k, v in run.traces.items() if k != name})


SPOILERS = [
    ("study_factors", "", lambda run: spoiled(run, G1_small=run.traces["G1"])),
    ("same_model", "inertia_Genesis is 1.582",
     lambda run: with_readings(run, inertia_Genesis=1.582, inertia_MuJoCo=1.077)),
    ("same_model", "gravity_at_start_Genesis is 22.57",
     lambda run: with_readings(
         run, gravity_at_start_Genesis=22.57, gravity_at_start_MuJoCo=21.0)),
    ("implicit_term", "mass_KV_300_less_term is",
     lambda run: with_readings(run, mass_KV_300=2.5)),
    ("same_beginning", "same_samples is",
     lambda run: spoiled(run, G2_longer=run.traces["G1"])),
    ("grid_matches_cases", "G2, difference of position",
     lambda run: spoiled(run, grid_step_250mrad_KP_7000_KV_100=run.traces["G1"])),
    ("grid_within_gains", ".steps_with_another_target is 120",
     lambda run: spoiled(run, grid_step_20mrad_KP_3500_KV_100=run.traces["G1"])),
    ("small_step_unsaturated", "G2_small", lambda run: clipped(run, "start_control_force")),
    ("small_step_unsaturated", "G2_small", lambda run: clipped(run, "control_force")),
    ("theory_small_step", "G1_small.overshoot_share is", off_theory),
    ("theory_small_step", "G1_small.distance_to_theory is", as_theory),
    ("gravity_support", "G2", lambda run: with_readings(run, gravity_G2=30.0)),
    ("gravity_support", "cases_at_rest is none", moving),
    ("convergence", "fall_from_2_to_4_substeps_rad is -",
     lambda run: with_overshoot(run, "G2_substeps_4", 0.07)),
    ("convergence", "fall_from_20_to_50_substeps_rad is -",
     lambda run: with_overshoot(run, "G2_substeps_50", 0.07)),
    ("one_limit", "spread_at_finest_step_rad is",
     lambda run: with_overshoot(run, "G2_substeps_50", 0.0415)),
    ("second_engine_order", "implicitfast: overshoot",
     lambda run: with_cases_swapped(run, "implicitfast")),
    ("stepped_model", "G1_small.overshoot_share_of_model", off_theory),
    ("stepped_model", "G2.overshoot_of_model_rad",
     lambda run: with_overshoot(run, "G2", 0.1)),
    *((check, f"'{name}'", lambda run, n=name: without(run, n))
      for check, name in (("gravity_support", "G2"), ("study_factors", "G1_hold"),
                          ("convergence", "G2_substeps_10"))),
]  # fmt: skip


def test_every_check_passes_on_sound_runs_and_has_a_spoiler(study_runs):
    assert failed(study_runs) == {}
    assert failed(with_overshoot(study_runs, "G2_substeps_50", 0.0235)) == {}
    assert {name for name, *_ in SPOILERS} == {check.__name__ for check in own_checks()}


@pytest.mark.parametrize(("name", "says", "spoil"), SPOILERS)
def test_a_spoiled_run_fails_by_name(study_runs, name, says, spoil):
    assert says in failed(spoil(study_runs))[name]


PARTED = Parting(time=0.03, distance=0.12, clipped=2, efforts=3)
UNDER = IdealJoint(1.077, 101.0, 3500.0)


@pytest.mark.parametrize(
    ("found", "says", "not_said"),
    [
        (PARTED, "0.01 rad at 0.03 s. The largest distance in this window is 0.1200 rad", "reason"),
        (PARTED, "2 of 3 efforts were clipped.", "stays within"),
        (replace(PARTED, clipped=1, efforts=1), "The first effort, at t = 0, was clipped.", "of 1"),
        (replace(PARTED, clipped=0), "saturation is not the reason. Look", "higher gain could"),
        (replace(PARTED, time=None, distance=0.004), "stays within 0.01 rad", "clipped"),
    ],
)
def test_the_parting_is_described_as_it_was_found(found, says, not_said):
    text = theory_text.parting_sentence("G1", UNDER, found)
    assert text.startswith("G1 (ζ = 0.82, underdamped)")
    assert says in text
    assert not_said not in text


@pytest.mark.parametrize(
    ("small", "large", "says"),
    [
        (0.12, 0.30, "is 1.1 times the ideal overshoot. The large step does not agree."),
        (0.12, 0.11, "one number can agree by accident"),
        (
            0.20,
            0.11,
            "Even the small step differs from the ideal one by more than 3 percentage points",
        ),
    ],
)
def test_step_sizes_are_compared_with_theory(small, large, says):
    text = theory_text.step_size_sentence("G2", 0.106, small, large)
    assert "overshoots by 10.6 % of its step" in text
    assert says in text


@pytest.mark.parametrize(
    ("effort", "velocity", "says", "not_said"),
    [
        (21.5, 0.0, "A balance between the motor and gravity", "does not explain"),
        (21.5, 0.0, "0.0062 rad, takes 62 % of the settling band, 0.01 rad.", "does not explain"),
        (30.0, 0.0, "Gravity alone does not explain the error", "balance"),
        (21.5, 0.5, "G1 still moved at the last sample.", "does not prove"),
    ],
)
def test_gravity_is_compared_with_kp_times_error(study_runs, effort, velocity, says, not_said):
    m = replace(study_runs.metrics["G1"], final_error=0.0062, final_velocity=velocity)
    (row,) = lecture_text.gravity_rows({"G1": 3500.0}, {"G1": m}, {"G1": effort})
    assert row["KP × final error"] == "21.70 N·m"
    assert row["gravity, engine"] == f"{effort:.2f} N·m"
    text = " ".join(lecture_text.gravity_sentences({"G1": 3500.0}, {"G1": m}, {"G1": effort}))
    assert says in text
    assert not_said not in text


@pytest.mark.parametrize(
    ("fine", "says"),
    [(0.0210, "mostly from the numerical method"), (0.0400, "does not bring them together")],
)
def test_convergence_is_read_from_the_spread(fine, says):
    overshoot = {
        "Genesis": {2: 0.0447, 50: fine},
        "implicitfast": {2: 0.0195, 50: 0.0195},
        "Euler": {50: 0.0193},
    }
    told = list(engine_comparison.convergence_sentences(overshoot, 2))
    assert (
        f"Genesis: from 2 to 50 substeps the overshoot changes from 0.0447 rad to {fine:.4f} rad."
        in told
    )
    assert told[1].endswith("the overshoot does not change measurably.")
    assert told[2].startswith("MuJoCo Euler is unstable at 2 substeps.")
    assert says in told[-1]


@pytest.mark.parametrize(
    ("finer", "says"),
    [(0.0253, "From 20 to 50 substeps it still changes by 0.0030 rad"), (0.0225, "")],
)
def test_a_method_that_the_last_refinement_changes_has_not_converged(finer, says):
    values = {2: 0.0447, 20: finer, 50: 0.0223}
    text = engine_comparison.last_change(values, 2)
    assert says in text
    assert bool(says) == ("has not converged" in text)
    assert engine_comparison.last_change({2: 0.0447, 50: 0.0223}, 2) == ""


def test_the_first_step_tells_engines_whose_kv_acts_while_clipped(study_runs):
    rows = engine_comparison.first_step_rows(study_runs)
    assert [row["case"] for row in rows] == ["G1", "G2", "G3"]
    text = engine_comparison.first_step_sentence(study_runs)
    assert "They move alike in MuJoCo implicitfast and MuJoCo Euler" in text
    assert "They differ in Genesis: there KV acts although the effort is clipped." in text
    alike = replace(study_runs.traces["G3"], qd=study_runs.traces["G2"].qd)
    text = engine_comparison.first_step_sentence(spoiled(study_runs, G3=alike))
    assert "They move alike in Genesis, MuJoCo implicitfast and MuJoCo Euler" in text
    assert "They differ" not in text


@pytest.mark.parametrize("term", [0.0, 100.0])
def test_the_joint_alone_is_the_equation_by_hand(study_runs, term):
    case, readings = study_spec.COMPARED["G1"], study_runs.readings[study.GROUP]
    damping = readings["passive_damping"]
    h, effort = case.dt / case.substeps, study_runs.traces["G1"].start_control_force[K]
    net = effort - readings["gravity_at_start_Genesis"]
    mass = readings["inertia_Genesis"] + h * (damping + term)
    after_one = h * net / mass
    expected = after_one + h * (net - damping * after_one) / mass
    assert engine_comparison.alone(study_runs, "G1", term) == pytest.approx(expected)


def test_a_first_step_that_was_not_clipped_isolates_nothing(study_runs):
    free = study_runs.traces["G3"]
    free = replace(free, start_control_force=free.start_control_force * 0.5)
    text = engine_comparison.first_step_sentence(spoiled(study_runs, G3=free))
    assert "do not isolate the integrator" in text
    assert "alike" not in text


def test_relations_are_shown_for_every_engine_and_unstable_runs_are_marked(study_runs):
    rows = engine_comparison.relation_rows(study_runs)
    assert len(rows) == len(spec.RELATIONS)
    for row in rows:
        states = [row[label].split(":")[0] for label in engine_comparison.ENGINE_LABELS.values()]
        assert states == ["held", "held", "unstable"]
    text = engine_comparison.survival_sentence(study_runs)
    assert f"All {len(spec.RELATIONS)} orderings" in text
    assert "hold in Genesis and MuJoCo implicitfast." in text
    assert "MuJoCo Euler is left out, because its runs are unstable." in text


def test_a_relation_that_breaks_is_reported(study_runs):
    text = engine_comparison.survival_sentence(with_cases_swapped(study_runs, "implicitfast"))
    assert "overshoot higher in G2 than in G1 (MuJoCo implicitfast: broken)" in text
    assert "All" not in text


def test_a_run_is_unstable_if_a_joint_is_clipped_in_most_samples(study_runs):
    found = {n: study.unstable(study_runs, "Euler", n) for n in study_spec.SUBSTEPS_STUDIED}
    assert found == {1: True, 2: True, 4: True, 10: True, 20: False, 50: False}
    assert not any(study.unstable(study_runs, e) for e in ("Genesis", "implicitfast"))
    trace = study_runs.traces["G2"]
    force = np.array(trace.control_force)
    force[: len(force) // 2, K] = 87.0
    assert study.unstable_joints(replace(trace, control_force=force)) == []
    force[: len(force) // 2 + 1, K] = 87.0
    assert study.unstable_joints(replace(trace, control_force=force)) == ["joint4"]
    rows = engine_comparison.convergence_rows(study_runs)
    assert [row["MuJoCo Euler"].endswith("(unstable)") for row in rows] == list(found.values())


def test_the_spread_counts_stable_runs_alone(study_runs):
    values = [study.overshoot_by_substeps(study_runs, e)[2] for e in ("Genesis", "implicitfast")]
    assert study.spread(study_runs, 2) == max(values) - min(values)


def test_the_stepped_model_is_compared_run_by_run(study_runs):
    rows = theory_text.stepped_table(study_runs).splitlines()[2:]
    assert [row.split("|")[1].strip() for row in rows] == [
        "G1, +0.005 rad", "G2, +0.005 rad", "G1, +0.25 rad", "G2, +0.25 rad", "G3, +0.25 rad",
    ]  # fmt: skip
    text = theory_text.stepped_sentences(study_runs)
    assert "percentage points from the engine" in text
    assert text.count("The model predicts correctly whether this case overshoots.") == 3
    none = {name: replace(m, overshoot=0.0) for name, m in study_runs.metrics.items()}
    text = theory_text.stepped_sentences(replace(study_runs, accepted=none))
    assert text.count("The model does not predict correctly") == 1


def test_rows_of_the_tables_are_the_study_runs_values(study_runs):
    rows = engine_comparison.convergence_rows(study_runs)
    assert [row["substeps"] for row in rows] == list(study_spec.SUBSTEPS_STUDIED)
    overshoots = study.overshoot_by_substeps(study_runs, "Genesis").values()
    assert [row["Genesis"] for row in rows] == [f"{value:.4f} rad" for value in overshoots]
    regimes = {row["case"]: row["ideal joint"] for row in theory_text.ideal_rows(study_runs)}
    assert regimes == {"G1": "underdamped", "G2": "underdamped", "G3": "overdamped"}
    assert theory_text.damping_word(1.0) == "critically damped"
    assert len(theory_text.parting_sentences(study_runs)) == len(study_spec.COMPARED)
    assert len(theory_text.step_size_sentences(study_runs)) == len(study_spec.SMALL_STEPPED)
    sizes, ideal = theory_text.step_size_rows(study_runs), study.ideal(study_runs, "G2")
    assert sizes[1]["overshoot, ideal"] == theory_text.share_text(ideal.overshoot)


def test_chatter_is_counted_for_each_joint(study_runs):
    traces = {
        name: study_runs.traces[study.run_name(name, "G2", 2)]
        for name in study_spec.SECOND_INTEGRATORS
    }
    inertia, _ = mujoco_joints.at_rest(spec.G2, Q_START)
    ratio = DT / 2 * (spec.G2.kv + 1) / inertia
    text = engine_comparison.explicit_sentence(JOINT_NAMES, ratio, traces)
    assert "above two for joint1, joint5, joint6 and joint7" in text
    assert "With implicitfast, no joint had" in text
    assert re.search(r"With Euler, .*joint7 had", text)
    none = engine_comparison.explicit_sentence(JOINT_NAMES, np.zeros(9), {})
    assert none == "h (KV + d) / I is above two for no joint."
    rows = engine_comparison.explicit_rows(JOINT_NAMES, ratio, traces)
    euler = step_metrics(traces["Euler"], K)
    assert rows[K]["clipped, Euler"] == f"{euler.saturation_samples} samples"


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
    values = {10: (0.05, True), 5: (0.04, False), 2: (0.03, False)}
    study_plots.convergence(ax, {"Genesis": values}, 5)
    assert drawn(ax)["Genesis"].tolist() == [0.04, 0.03]
    assert drawn(ax)["Genesis, unstable"].tolist() == [0.05]
    assert ax.get_xscale() == "log"
