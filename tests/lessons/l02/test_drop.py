"""A dropped box: known answers, metrics, named checks, sentences, the study of steps."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core import tables
from robo_genesis.core.checks import CheckFailed, require
from robo_genesis.core.free_fall import (
    ahead_of_continuous,
    continuous_drop,
    stepped_drop,
    summed_drop,
)
from robo_genesis.lessons.l02 import checks, plots, spec, study
from robo_genesis.lessons.l02 import text as drop_said
from robo_genesis.lessons.l02.metrics import DropMetrics, fallen, measure, metric_records, predicted
from robo_genesis.sim.rigid_bodies import Drop, DropError, run_drop

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


def test_metrics_of_a_fall_that_follows_the_formula(make_drop):
    found = measure({"baseline": make_drop(spec.BASELINE)}, spec.CASES)["baseline"]
    assert found.duration == pytest.approx(0.2)
    assert found.drop == pytest.approx(9.81 * 0.005**2 * 40 * 41 / 2, abs=1e-7)
    assert found.final_speed == pytest.approx(9.81 * 0.2, rel=1e-6)
    assert found.formula_error < 1e-7
    assert found.continuous_gap == pytest.approx(0.5 * 9.81 * 0.005 * 0.2, abs=1e-7)
    assert (found.sideways, found.turning) == (0, 0)


def test_sideways_and_turning_are_the_largest_of_all_samples(make_drop):
    trace = make_drop(spec.BASELINE)
    aside, turn = np.array(trace.link_pos), np.array(trace.link_ang)
    aside[3, 0, :2] = (0.03, 0.04)
    turn[5, 0] = (0, 2, 0)
    found = measure({"baseline": replace(trace, link_pos=aside, link_ang=turn)}, spec.CASES)
    assert found["baseline"].sideways == pytest.approx(0.05)
    assert found["baseline"].turning == 2


def test_each_metric_has_unit_and_source_and_counts_are_exact(make_drop):
    metrics = measure({"baseline": make_drop(spec.BASELINE)}, spec.CASES)
    records = metric_records(metrics, spec.EXPECTED_MODEL, 0.5)
    assert records["model"]["dofs"] == {
        "value": 6,
        "unit": "1",
        "class": "exact",
        "from": ["engine"],
    }
    assert records["body"]["mass"]["unit"] == "kg"
    units = DropMetrics.about("unit")
    assert {name: of["unit"] for name, of in records["baseline"].items()} == units
    assert set(units.values()) <= spec.TOLERANCES.keys() & spec.RESOLUTION.keys()


@pytest.fixture
def experiment(make_drop, frames) -> checks.DropExperiment:
    traces = {name: make_drop(case) for name, case in ALL_CASES.items()}
    metrics = measure(traces, ALL_CASES)
    return checks.DropExperiment(
        spec.EXPECTED_MODEL, 0.5, ALL_CASES, traces, metrics, "camera", frames
    )


def failing(run) -> list[str]:
    return [check.name for check in checks.run_checks(run) if not check.passed]


def with_trace(run, **arrays):
    """Return the experiment with other arrays in the baseline, and metrics of these."""
    trace = replace(run.traces["baseline"], **arrays)
    traces = run.traces | {"baseline": trace}
    return replace(run, traces=traces, metrics=measure(traces, run.cases))


def test_a_sound_experiment_passes_every_check(experiment):
    assert failing(experiment) == []
    assert require("l02", checks.run_checks(experiment)) == "L02 CHECK: PASSED"


def test_one_more_link_or_a_wrong_mass_is_named(experiment):
    assert failing(replace(experiment, model=spec.EXPECTED_MODEL | {"links": 2})) == ["structure"]
    assert failing(replace(experiment, mass=0.51)) == ["mass"]


def test_a_start_elsewhere_is_named(experiment):
    position = np.array(experiment.traces["baseline"].link_pos)
    position[..., 2] += 0.01
    assert failing(with_trace(experiment, link_pos=position)) == ["start"]


def test_a_start_in_motion_is_named(experiment):
    velocity = np.array(experiment.traces["baseline"].link_vel)
    velocity[0, 0, 0] = 0.1
    assert failing(with_trace(experiment, link_vel=velocity)) == ["start"]


def test_a_run_that_is_too_short_is_named(experiment):
    trace = experiment.traces["baseline"]
    shorter = {name: getattr(trace, name)[:-1] for name in trace.__class__.__dataclass_fields__}
    assert "stamps" in failing(with_trace(experiment, **shorter))


def test_a_box_that_hovers_or_follows_another_rule_is_named(experiment, make_drop):
    hovering = np.array(experiment.traces["baseline"].link_pos)
    hovering[8] = hovering[7]
    assert failing(with_trace(experiment, link_pos=hovering)) == ["falls", "stepped_formula"]
    other = make_drop(replace(spec.BASELINE, substeps=4))
    found = with_trace(experiment, link_pos=other.link_pos)
    assert failing(found) == ["stepped_formula"]


def test_a_box_that_reaches_the_ground_is_named(experiment):
    position = np.array(experiment.traces["baseline"].link_pos)
    position[-1, 0, 2] = 0.049
    assert "clear_of_ground" in failing(with_trace(experiment, link_pos=position))


def test_a_push_from_the_side_is_named(experiment):
    position = np.array(experiment.traces["baseline"].link_pos)
    position[4, 0, 0] = 1e-4
    assert failing(with_trace(experiment, link_pos=position)) == ["straight_down"]


def test_a_speed_that_is_not_g_t_is_named(experiment):
    velocity = np.array(experiment.traces["baseline"].link_vel) / 2
    assert failing(with_trace(experiment, link_vel=velocity)) == ["speed"]


@pytest.mark.parametrize("turned", [(0, 1, 0, 0), (7, 0, 0, 0)])
def test_a_box_that_was_turned_over_or_has_no_orientation_is_named(experiment, turned):
    orientation = np.array(experiment.traces["baseline"].link_quat)
    orientation[5:] = turned
    assert failing(with_trace(experiment, link_quat=orientation)) == ["straight_down"]


@pytest.mark.parametrize(
    ("changed", "names"),
    [({"density": 1000}, ["mass"]), ({"height": 0.6}, ["start"]), ({"steps": 10}, ["stamps"])],
)
def test_the_hands_on_task_fails_the_checks_that_its_answer_names(
    make_drop, frames, changed, names
):
    case = replace(spec.BASELINE, **changed)
    traces = {"baseline": make_drop(case)}
    metrics = measure(traces, spec.CASES)
    found = checks.DropExperiment(
        spec.EXPECTED_MODEL, case.mass, spec.CASES, traces, metrics, "camera", frames
    )
    assert failing(found) == names


def test_boxes_that_end_apart_are_named():
    assert checks.same_fall({"ours": 0.3, "blue": 0.3}).passed
    outcome = checks.same_fall({"ours": 0.3, "blue": 0.29})
    assert not outcome.passed
    assert outcome.detail.startswith("blue ended -0.01 m")


def test_one_picture_twice_is_named(experiment):
    same = dict.fromkeys(("initial", "final"), experiment.frames["initial"])
    assert failing(replace(experiment, frames=same)) == ["posture"]
    with pytest.raises(CheckFailed, match=r"L02 CHECK: FAILED \[posture\]"):
        require("l02", checks.run_checks(replace(experiment, frames=same)))


def test_the_study_passes_on_formula_runs(experiment):
    assert all(c.passed for c in study.run_checks(experiment.metrics, ALL_CASES))
    found = study.study(experiment.metrics, ALL_CASES)
    assert found.names == ("substeps_1", "baseline", "substeps_4", "substeps_10", "substeps_20")
    assert found.gaps / found.gaps[-1] == pytest.approx([20, 10, 5, 2, 1], rel=5e-3)


def spoiled(metrics, **gaps):
    return metrics | {n: replace(metrics[n], continuous_gap=gap) for n, gap in gaps.items()}


@pytest.mark.parametrize(
    ("gaps", "names"),
    [
        ({"substeps_20": 0.02}, ["shrinks", "first_order"]),
        ({"substeps_20": -1e-4}, ["shrinks", "first_order"]),
        ({"substeps_20": 4e-4}, ["first_order"]),
    ],
)
def test_a_gap_that_does_not_shrink_as_it_must_is_named(experiment, gaps, names):
    outcomes = study.run_checks(spoiled(experiment.metrics, **gaps), ALL_CASES)
    assert [check.name for check in outcomes if not check.passed] == names


def test_a_second_factor_in_the_study_is_named(experiment):
    cases = ALL_CASES | {"substeps_4": replace(ALL_CASES["substeps_4"], height=0.6)}
    outcomes = study.run_checks(experiment.metrics, cases)
    assert [check.name for check in outcomes if not check.passed] == ["one_factor"]


def text(metrics, case=spec.BASELINE) -> str:
    said = "\n".join(block.markdown() for block in drop_said.interpretation(metrics, case))
    return said.replace("\N{NO-BREAK SPACE}", " ")


def test_sentences_of_a_sound_run(experiment):
    said = text(experiment.metrics["baseline"])
    assert "fell 0.201105 m: from 0.5 m to 0.298895 m" in said
    assert (
        "is 4.905 mm ahead of that, and g h t / 2 is 4.905 mm: the difference is the solver" in said
    )
    assert "which is float32" in said
    assert "neither moved aside" in said
    assert "at the lowest sample 248.9 mm were left below it" in said


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"formula_error": 1e-3}, "is up to 1e+03 µm off: it was not stepped as assumed"),
        ({"continuous_gap": 0.001}, "the solver's step does not explain the difference"),
        ({"final_speed": 1.5}, "1.9620 m/s. They differ by −0.4620 m/s. Look first at"),
        ({"sideways": 0.01}, "It moved 0.01 m aside"),
        ({"turning": 0.3}, "turned at up to 0.3 rad/s"),
        ({"lowest": 0.46}, "It reached the ground within the window"),
        ({"drop": -0.1}, "the box rose 0.100000 m: from 0.5 m to 0.600000 m"),
        ({"continuous_gap": -0.3}, "is 300.000 mm behind that"),
    ],
)
def test_sentences_of_other_outcomes(experiment, changed, said):
    assert said in text(replace(experiment.metrics["baseline"], **changed))


def test_convergence_says_first_order_only_where_it_is(experiment):
    found = study.study(experiment.metrics, ALL_CASES)
    assert "half the step leaves half" in " ".join(drop_said.convergence(found))
    off = study.study(spoiled(experiment.metrics, substeps_20=4e-4), ALL_CASES)
    said = " ".join(drop_said.convergence(off))
    assert "half the step" not in said
    assert "18 % off" in said


def test_tables_have_six_digits_and_signs(experiment):
    rows = drop_said.three_rows(experiment.metrics["baseline"], spec.BASELINE)
    assert [row["distance [m]"] for row in rows] == ["0.201105", "0.201105", "0.196200"]
    assert rows[2]["against the measurement [mm]"] == "−4.9050"
    table = tables.six_digits({"baseline": experiment.metrics["baseline"]})
    assert "| distance fallen | 0.201105 m |" in table


def test_figures_show_what_they_are_given(experiment):
    trace, case = experiment.traces["baseline"], spec.BASELINE
    axes = Figure().subplots(5)
    plots.height(axes[0], trace, case)
    plots.speed(axes[1], trace, case)
    plots.three_drops(axes[2], trace, case, predicted(trace, case))
    plots.gaps(axes[3], study.study(experiment.metrics, ALL_CASES))
    plots.schematic(axes[4], trace, case.size)
    assert axes[0].get_lines()[0].get_ydata() == pytest.approx(trace.link_pos[:, 0, 2])
    assert axes[1].get_lines()[1].get_ydata()[-1] == pytest.approx(9.81 * 0.2)
    measured = axes[2].get_lines()[2].get_ydata()
    assert measured == pytest.approx(1000 * (fallen(trace) - continuous_drop(trace.t)))
    assert len(axes[3].get_lines()[1].get_xdata()) == len(ALL_CASES)
    assert all(ax.get_xlabel() and ax.get_ylabel() for ax in axes)


class Scene:
    """A scene that lets a box fall by the formula; it knows no engine."""

    dt, substeps, is_built = 0.01, 2, True

    def __init__(self, height=0.5):
        self.height = height
        self.count = 0

    def reset(self):
        self.count = 0

    def step(self):
        self.count += 1


class Tensor:
    """What the engine returns, as far as it is used."""

    def __init__(self, *values):
        self.values = np.array([values], np.float32)

    def detach(self):
        return self

    cpu = detach

    def numpy(self):
        return self.values


class Box:
    def __init__(self, scene):
        self.scene = scene

    def get_links_pos(self):
        fallen = summed_drop(0.005, self.scene.count * self.scene.substeps)
        return Tensor(0, 0, self.scene.height - fallen)

    def get_links_vel(self):
        return Tensor(0, 0, -9.81 * 0.01 * self.scene.count)

    def get_links_ang(self):
        return Tensor(0, 0, 0)

    def get_links_quat(self):
        return Tensor(1, 0, 0, 0)


def test_a_run_keeps_the_state_before_the_first_step():
    scene = Scene()
    trace = run_drop(scene, Box(scene), spec.BASELINE)
    assert (trace.steps, len(trace.t), trace.link_pos.shape) == (20, 21, (21, 1, 3))
    assert trace.link_pos[0, 0, 2] == np.float32(0.5)
    assert trace.dt == 0.01


def test_a_run_that_was_not_made_ready_is_refused():
    scene = Scene()
    with pytest.raises(DropError, match=r"built with dt=0.01, substeps=2.*asks for dt=0.01, sub"):
        run_drop(scene, Box(scene), replace(spec.BASELINE, substeps=4))
    low = Scene(height=0.4)
    with pytest.raises(DropError, match=r"starts at a height of 0\.4 m.*asks for 0\.5 m"):
        run_drop(low, Box(low), spec.BASELINE)
    scene.is_built = False
    with pytest.raises(DropError, match=r"call scene\.build\(\)"):
        run_drop(scene, Box(scene), spec.BASELINE)
