"""A dropped box: known answers, metrics, named checks, sentences, the study of steps."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from lessons.body_runs import make_drop

from robo_genesis.core import tables
from robo_genesis.core.checks import evaluate, require
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.free_fall import (
    ahead_of_continuous,
    continuous_drop,
    stepped_drop,
    summed_drop,
)
from robo_genesis.lessons.l02 import LAB, LECTURE, plots, spec, study, text
from robo_genesis.lessons.l02.metrics import drop_metrics
from robo_genesis.sim.bodies.falls import fallen
from robo_genesis.sim.bodies.rigid_bodies import Drop, DropError, run_drop

ALL_CASES = spec.CASES | spec.SUBSTEP_CASES


def test_one_second_of_continuous_fall_is_half_of_g():
    assert continuous_drop(np.array([0.0, 1.0, 2.0])).tolist() == [0.0, 4.905, 19.62]


def test_two_solver_steps_by_hand():
    # v = 1, z = 1 · 0.1; v = 2, z = 0.1 + 2 · 0.1, with g h = 1
    assert stepped_drop(0.1, 2, gravity=10).tolist() == pytest.approx([0, 0.1, 0.3])


@pytest.mark.parametrize(("h", "n"), [(0.1, 1), (0.005, 40), (0.0005, 400)])
def test_the_sum_is_what_the_loop_adds_up_to(h, n):
    assert summed_drop(h, np.arange(n + 1)) == pytest.approx(stepped_drop(h, n), rel=1e-12)


def test_stepped_fall_is_ahead_of_continuous_fall_by_half_of_g_h_t():
    h, n = 0.005, 40
    gap = summed_drop(h, n) - continuous_drop(h * n)
    assert gap == pytest.approx(ahead_of_continuous(h, h * n), rel=1e-12)
    assert gap == pytest.approx(0.5 * 9.81 * 0.005 * 0.2)


def test_a_case_knows_its_step_mass_and_clearance():
    case = Drop(size=0.1, density=500, height=0.5, steps=20)
    assert (case.h, case.mass, case.clearance) == pytest.approx((0.005, 0.5, 0.45))


def test_metrics_of_a_fall_that_follows_the_formula():
    found = drop_metrics(make_drop(spec.BASELINE), spec.BASELINE)
    assert found.duration == pytest.approx(0.2)
    assert found.drop == pytest.approx(9.81 * 0.005**2 * 40 * 41 / 2, abs=1e-7)
    assert found.final_speed == pytest.approx(9.81 * 0.2, rel=1e-6)
    assert found.formula_error < 1e-7
    assert found.continuous_gap == pytest.approx(0.5 * 9.81 * 0.005 * 0.2, abs=1e-7)
    assert (found.sideways, found.turning) == (0, 0)


def test_sideways_and_turning_are_the_largest_of_all_samples():
    trace = make_drop(spec.BASELINE)
    aside, turn = np.array(trace.link_pos), np.array(trace.link_ang)
    aside[3, 0, :2] = (0.03, 0.04)
    turn[5, 0] = (0, 2, 0)
    found = drop_metrics(replace(trace, link_pos=aside, link_ang=turn), spec.BASELINE)
    assert found.sideways == pytest.approx(0.05)
    assert found.turning == 2


@pytest.fixture(scope="module")
def experiment(frames) -> Experiment:
    """The lecture's runs as the lab judges them."""
    traces = {name: make_drop(case) for name, case in ALL_CASES.items()}
    page = replace(LAB, runs=LECTURE.runs)
    return Experiment(page, traces, [spec.LINK], readings(), frames, rendered=True)


def readings(links=1, mass=0.5):
    return {"model": spec.EXPECTED_MODEL | {"links": links}, "body": {"mass": mass}}


def failing(run) -> list[str]:
    return [check.name for check in run.outcomes() if not check.passed]


def with_trace(run, **arrays):
    """Return the experiment with other arrays in the baseline."""
    trace = replace(run.traces["baseline"], **arrays)
    return replace(run, traces=run.traces | {"baseline": trace})


def test_a_sound_experiment_passes_every_check(experiment):
    assert failing(experiment) == []
    assert require("l02", experiment.outcomes()) == "L02 CHECK: PASSED"


def test_readers_see_words_instead_of_names(experiment):
    shown = "".join(show(experiment) for show in (text.metric_table, text.substep_table))
    assert [name for name in ALL_CASES if name in shown] == []
    assert spec.LABELS["baseline"] in shown
    assert spec.LABELS.keys() == ALL_CASES.keys()
    assert (spec.LABELS["substeps_1"], spec.LABELS["baseline"], spec.LABELS["substeps_20"]) == (
        "1 substep of 10 ms", "2 substeps of 5 ms", "20 substeps of 0.5 ms")  # fmt: skip


def changed(field, where, values):
    """Return a function that assigns values to some states of one array of the baseline."""

    def change(run):
        array = np.array(getattr(run.traces["baseline"], field))
        array[where] = values
        return with_trace(run, **{field: array})

    return change


def too_short(run):
    trace = run.traces["baseline"]
    return with_trace(run, **{f: getattr(trace, f)[:-1] for f in trace.__dataclass_fields__})


def hovering(run):
    return changed("link_pos", 8, run.traces["baseline"].link_pos[7])(run)


FAILING = {
    "one more link": (
        lambda run: replace(run, readings=readings(links=2)), ["structure"]),
    "a wrong mass": (lambda run: replace(run, readings=readings(mass=0.51)), ["mass"]),
    "a start elsewhere": (lambda run: with_trace(
        run, link_pos=run.traces["baseline"].link_pos + np.float32([0, 0, 0.01])), ["start"]),
    "a start in motion": (changed("link_vel", (0, 0, 0), 0.1), ["start"]),
    "a run that is too short": (too_short, ["stamps"]),
    "a box that hovers": (hovering, ["falls", "stepped_formula"]),
    "another rule of stepping": (lambda run: with_trace(
        run, link_pos=run.traces["substeps_4"].link_pos), ["stepped_formula"]),
    "a box that reaches the ground": (
        changed("link_pos", (-1, 0, 2), 0.049), ["clear_of_ground", "stepped_formula"]),
    "a push from the side": (changed("link_pos", (4, 0, 0), 1e-4), ["straight_down"]),
    "a speed that is not g t": (
        lambda run: with_trace(run, link_vel=run.traces["baseline"].link_vel / 2), ["speed"]),
    "a box that was turned over": (
        changed("link_quat", slice(5, None), (0, 1, 0, 0)), ["straight_down"]),
    "a box without an orientation": (
        changed("link_quat", slice(5, None), (7, 0, 0, 0)), ["straight_down"]),
    "one picture twice": (lambda run: replace(
        run, frames=dict.fromkeys(run.frames, run.frames["initial"])), ["posture"]),
}  # fmt: skip


@pytest.mark.parametrize("name", FAILING)
def test_a_wrong_experiment_fails_its_checks(experiment, name):
    spoil, names = FAILING[name]
    assert failing(spoil(experiment)) == names


@pytest.mark.parametrize(
    ("changes", "names"),
    [({"density": 1000}, ["mass"]), ({"height": 0.6}, ["start"]), ({"steps": 10}, ["stamps"])],
)
def test_the_hands_on_task_fails_the_checks_that_its_answer_names(experiment, changes, names):
    case = replace(spec.BASELINE, **changes)
    traces = {"baseline": make_drop(case)}
    run = replace(experiment, page=LAB, traces=traces, readings=readings(mass=case.mass))
    assert failing(run) == names


def failing_study(metrics, cases=ALL_CASES) -> list[str]:
    run = SimpleNamespace(metrics=metrics, cases=cases)
    return [check.name for check in evaluate(study.CHECKS, run) if not check.passed]


def test_the_study_passes_on_formula_runs(experiment):
    assert failing_study(experiment.metrics) == []
    found = study.step_study(experiment.metrics, ALL_CASES)
    assert found.names == ("substeps_1", "baseline", "substeps_4", "substeps_10", "substeps_20")
    assert found.gaps / found.gaps[-1] == pytest.approx([20, 10, 5, 2, 1], rel=5e-3)


def with_gap(metrics, gap):
    """Return the metrics with another gap at the smallest solver step."""
    return metrics | {"substeps_20": replace(metrics["substeps_20"], continuous_gap=gap)}


@pytest.mark.parametrize(
    ("gap", "names"),
    [
        (0.02, ["shrinks", "first_order"]),
        (-1e-4, ["shrinks", "first_order"]),
        (4e-4, ["first_order"]),
    ],
)
def test_a_gap_that_does_not_shrink_as_it_must_is_named(experiment, gap, names):
    assert failing_study(with_gap(experiment.metrics, gap)) == names


def test_a_second_factor_in_the_study_is_named(experiment):
    cases = ALL_CASES | {"substeps_4": replace(ALL_CASES["substeps_4"], height=0.6)}
    assert failing_study(experiment.metrics, cases) == ["one_factor"]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({}, "fell 0.201105 m, from 0.5 m to 0.298895 m"),
        ({}, "is 4.905 mm ahead of that, and g h t / 2 is 4.905 mm: the solver step causes"),
        ({}, "which is float32 rounding"),
        ({}, "neither moved sideways"),
        ({}, "at its lowest sample it was 248.9 mm above it"),
        ({"formula_error": 1e-3}, "differs by up to 1e+03 µm: it was not stepped as assumed"),
        ({"continuous_gap": 0.001}, "the solver step does not explain the difference"),
        ({"final_speed": 1.5}, "1.9620 m/s. They differ by −0.4620 m/s. Check"),
        ({"sideways": 0.01}, "It moved 0.01 m sideways"),
        ({"turning": 0.3}, "turned at up to 0.3 rad/s"),
        ({"lowest": 0.46}, "It reached the ground within the window"),
        ({"drop": -0.1}, "the box rose 0.100000 m, from 0.5 m to 0.600000 m"),
        ({"continuous_gap": -0.3}, "is 300.000 mm behind that"),
    ],
)
def test_sentences_of_every_outcome(experiment, changes, sentence):
    metrics = replace(experiment.metrics["baseline"], **changes)
    blocks = text.interpretation(metrics, spec.BASELINE)
    found = "\n".join(block.markdown() for block in blocks)
    assert sentence in found.replace("\N{NO-BREAK SPACE}", " ")


def test_convergence_says_first_order_only_where_it_is(experiment):
    found = study.step_study(experiment.metrics, ALL_CASES)
    assert "half the step leaves half" in " ".join(text.convergence(found))
    off = study.step_study(with_gap(experiment.metrics, 4e-4), ALL_CASES)
    sentences = " ".join(text.convergence(off))
    assert "half the step" not in sentences
    assert "by 18 %" in sentences


def test_tables_have_six_digits_and_signs(experiment):
    rows = text.three_rows(experiment.metrics["baseline"], spec.BASELINE)
    assert [row["distance [m]"] for row in rows] == ["0.201105", "0.201105", "0.196200"]
    assert rows[2]["against the measurement [mm]"] == "−4.9050"
    unseen = replace(experiment.metrics["baseline"], drop=None)
    assert [text.readable(v, "m") for v in (None, 0.201105, 0.0, -0.00490494, 6.9e-8)] == [
        "not observed", "0.2011 m", "0.0000 m", "−4.9 mm", "0.069 µm"]  # fmt: skip
    assert text.readable(1.962, "m/s") == "1.962 m/s"
    assert "| 10 | 1 | 0.197181 | 0.981 | 0.981 |" in text.substep_table(experiment)
    table = tables.six_digits({"baseline": experiment.metrics["baseline"], "unseen": unseen})
    assert "| distance fallen | 0.201105 m | not observed |" in table


def test_figures_show_what_they_are_given(experiment):
    trace, case = experiment.traces["baseline"], spec.BASELINE
    without_camera = replace(experiment, rendered=False)
    drawn = (plots.height_and_speed, plots.three_drops, plots.gaps, plots.posture)
    axes = [ax for function in drawn for ax in function(without_camera).axes]
    height, speed, drops, gaps, _ = axes
    assert height.get_lines()[0].get_ydata() == pytest.approx(trace.link_pos[:, 0, 2])
    assert speed.get_lines()[1].get_ydata()[-1] == pytest.approx(9.81 * 0.2)
    measured = drops.get_lines()[2].get_ydata()
    assert measured == pytest.approx(1000 * (fallen(trace) - continuous_drop(trace.t)))
    assert len(gaps.get_lines()[1].get_xdata()) == len(ALL_CASES)
    assert all(ax.get_xlabel() and ax.get_ylabel() for ax in axes[1:])
    assert case.size == pytest.approx(np.ptp(axes[-1].get_lines()[0].get_xdata()))
    assert len(plots.posture(experiment).axes) == 2


@pytest.mark.parametrize(
    ("found", "message"),
    [
        ({"substeps": 4}, r"built with dt=0.01, substeps=4.*asks for dt=0.01, substeps=2"),
        ({"is_built": False}, r"call scene\.build\(\)"),
        ({"get_links_pos": lambda: [[0, 0, 0.4]]}, r"a height of 0\.4 m.*asks for 0\.5 m, at rest"),
        ({"get_links_vel": lambda: [[0, 0, 1.5]]}, r"with velocity \[0\.0, 0\.0, 1\.5\] m/s"),
    ],
)
def test_a_scene_that_was_not_made_ready_for_the_case_is_refused(found, message):
    ready = {"dt": 0.01, "substeps": 2, "is_built": True, "reset": lambda: None}
    ready |= {f"get_links_{name}": lambda: [[0, 0, 0]] for name in ("quat", "vel", "ang")}
    scene = SimpleNamespace(**ready | {"get_links_pos": lambda: [[0, 0, 0.5]]} | found)
    with pytest.raises(DropError, match=message):
        run_drop(scene, scene, spec.BASELINE)
