"""A dropped box without the engine: known answers, and for each check a run that fails it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from lessons.body_runs import make_drop
from lessons.changed_runs import failed, with_reading, with_trace

from robo_genesis.core.checks import evaluate
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import LAB, life_cycle, plots, spec, study, text, trials
from robo_genesis.lessons.l02.metrics import drop_metrics


def test_the_metrics_are_the_largest_of_all_samples():
    sound = make_drop(spec.BASELINE)
    aside, turn = np.array(sound.link_pos), np.array(sound.link_ang)
    aside[3, 0, :2] = (0.03, 0.04)
    turn[5, 0] = (0, 2, 0)
    found = drop_metrics(replace(sound, link_pos=aside, link_ang=turn), spec.BASELINE)
    assert (found.sideways, found.turning) == pytest.approx((0.05, 2))
    assert (found.duration, found.drop) == pytest.approx((0.2, 9.81 * 0.005**2 * 40 * 41 / 2))
    assert found.final_speed == pytest.approx(9.81 * 0.2)
    assert found.continuous_gap == pytest.approx(0.5 * 9.81 * 0.005 * 0.2, abs=1e-7)
    assert found.formula_error < 1e-7


def changed(field, where, values):
    """Return a function that assigns values to some states of one array of the baseline."""

    def change(run):
        array = np.array(getattr(run.traces["baseline"], field))
        array[where] = values
        return with_trace(run, "baseline", **{field: array})

    return change


def too_short(run):
    trace = run.traces["baseline"]
    fields = ("t", "link_pos", "link_quat", "link_vel", "link_ang")
    shorter = BodyTrace(*(getattr(trace, name)[:-1] for name in fields))
    return replace(run, traces={**run.traces, "baseline": shorter})


def at_every_sample(run):
    faster = run.traces["substeps_4"]
    return with_trace(run, "baseline", link_pos=faster.link_pos)


def reading(group, name, value):
    return lambda run: with_reading(run, group, name, value)


SPOILED = {
    "one more link": (reading("model", "links", 2), {"structure"}),
    "a wrong mass": (reading("body", "mass", 0.51), {"mass"}),
    "a start in motion": (changed("link_vel", (0, 0, 0), 0.1), {"start"}),
    "a run that is too short": (too_short, {"stamps"}),
    "a box that hovers": (changed("link_pos", (8, 0, 2), 0.5), {"falls", "stepped_formula"}),
    "another rule of stepping": (at_every_sample, {"stepped_formula", "first_order", "shrinks"}),
    "a box that reaches the ground": (
        changed("link_pos", (-2, 0, 2), 0.049), {"falls", "clear_of_ground", "stepped_formula"}),
    "a push from the side": (changed("link_pos", (4, 0, 0), 1e-4), {"straight_down"}),
    "a box without an orientation": (changed("link_quat", -1, (7, 0, 0, 0)), {"straight_down"}),
    "a speed that is not g t": (changed("link_vel", (5, 0, 2), -0.6), {"falls", "speed"}),
    "one picture twice": (lambda run: replace(
        run, frames=dict.fromkeys(run.frames, run.frames["initial"])), {"posture"}),
    "no picture of the trays": (lambda run: replace(run, frames={
        name: of for name, of in run.frames.items() if name != spec.TRAYS}), {"invisible_lid"}),
    "a mesh that collides as it is drawn": (
        reading("shapes", "duck_felt", 3534), {"two_geometries"}),
    "a tray in one piece": (reading("shapes", "tray_pieces", 1), {"two_geometries"}),
    "a ball that fell through the lid": (reading("trays", "hull", 0.0308), {"invisible_lid"}),
    "a heavier box that falls faster": (reading("further", "heavier", 0.21), {"further_falls"}),
    "a call on the wrong side": (
        reading(life_cycle.GROUP, "scene.step before build", 1), {"sides_of_build"}),
}  # fmt: skip


def test_a_sound_run_passes_all_checks_and_the_lab_says_so(run):
    assert failed(run) == set()
    lab = replace(run, page=LAB)
    assert [name for name in text.SENTENCES if f"`{name}` failed" in text.conclusions(lab)] == []
    assert "The box fell 0.2011 m in 0.20 s" in text.conclusions(lab)


@pytest.mark.parametrize("name", SPOILED)
def test_a_spoiled_run_fails_its_check_and_the_lab_says_which(run, name):
    spoil, names = SPOILED[name]
    spoiled = spoil(run)
    assert failed(spoiled) == names
    said = text.conclusions(spoiled)
    assert {of for of in text.SENTENCES if f"`{of}` failed" in said} == names & {*text.SENTENCES}


def test_each_check_has_a_run_that_fails_it(run):
    fails = {name for _, names in SPOILED.values() for name in names} | {"one_factor", "free_fall"}
    assert fails == {check.__name__ for check in run.page.checks}


@pytest.mark.parametrize(
    ("changes", "names"),
    [({"density": 1000}, {"mass"}), ({"height": 0.6}, {"start", "free_fall"}),
     ({"steps": 10}, {"stamps", "free_fall"})],
)  # fmt: skip
def test_the_task_of_the_lab_fails_the_checks_of_its_answer(run, frames, changes, names):
    case = replace(spec.BASELINE, **changes)
    changed = replace(
        with_reading(run, "body", "mass", case.mass),
        page=LAB, traces={"baseline": make_drop(case)}, frames=frames,
    )  # fmt: skip
    assert {check.name for check in changed.outcomes() if not check.passed} == names


@pytest.mark.parametrize(
    ("changes", "names"), [({"height": 0.6}, ["one_factor"]), ({"gravity": 9.0}, ["one_factor"])]
)
def test_a_second_factor_in_the_study_is_named(run, changes, names):
    cases = run.cases | {"substeps_4": replace(run.cases["substeps_4"], **changes)}
    other = SimpleNamespace(metrics=run.metrics, cases=cases)
    outcomes = evaluate(study.CHECKS[:2], other)
    assert [check.name for check in outcomes if not check.passed] == names


def test_a_loop_that_differs_from_the_record_is_named():
    trace = make_drop(spec.BASELINE)
    heights = [float(z) for z in trace.link_pos[:, 0, 2]]
    assert trials.same_heights(heights, trace).passed
    assert not trials.same_heights(heights[1:], trace).passed
    assert not trials.same_heights([*heights[:-1], 0.3], trace).passed


def test_tables_have_words_units_and_signs(run):
    assert "| continuous, g t² / 2 | 0.196200 | −4.9050 |" in text.three_drops(run)
    assert "| 10 | 1 | 0.197181 | 0.981 | 0.981 |" in text.substep_table(run)
    assert "| on the Moon, g = 1.62 m/s² | 0.033210 | 0.033210 |" in text.falls_table(run)
    assert "| metric | 2 substeps of 5 ms |" in text.metric_table(run)
    found = [text.readable(value, "m") for value in (None, 0.201105, 0.0, -0.00490494, 6.9e-8)]
    assert found == ["not observed", "0.2011 m", "0.0000 m", "−4.9 mm", "0.069 µm"]


def test_figures_show_what_they_are_given(run):
    without_camera = replace(run, rendered=False)
    height, speed = plots.height_and_speed(run).axes
    trace = run.traces["baseline"]
    assert height.get_lines()[0].get_ydata() == pytest.approx(trace.link_pos[:, 0, 2])
    assert speed.get_lines()[1].get_ydata()[-1] == pytest.approx(9.81 * 0.2)
    assert len(plots.gaps(run).axes[0].get_lines()[1].get_xdata()) == len(run.cases)
    (heights,) = plots.trays(without_camera).axes
    assert [bar.get_height() for bar in heights.patches] == [0.0308, 0.1749]
    assert [len(plots.posture(of).axes) for of in (run, without_camera)] == [2, 1]
