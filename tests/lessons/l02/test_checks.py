"""A dropped box without the engine: known answers, and for each check a run that fails it."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import make_drop
from lessons.changed_runs import case, copied, failed, frames, put, reading, trace

from robo_genesis.lessons.l02 import life_cycle, plots, spec, text
from robo_genesis.lessons.l02.metrics import drop_metrics
from robo_genesis.lessons.l02.pages import DROP


def test_the_metrics_are_the_largest_of_all_samples():
    sound = make_drop(spec.BASELINE)
    aside, turn = np.array(sound.link_pos), np.array(sound.link_ang)
    aside[3, 0, :2] = (0.03, 0.04)
    turn[5, 0] = (0, 2, 0)
    found = drop_metrics(replace(sound, link_pos=aside, link_ang=turn), spec.BASELINE)
    assert (found.sideways, found.turning) == pytest.approx((0.05, 2))
    assert (found.duration, found.drop) == pytest.approx(
        (0.2, 9.81 * 0.005**2 * 40 * 41 / 2)
    )
    assert found.final_speed == pytest.approx(9.81 * 0.2)
    assert found.continuous_gap == pytest.approx(0.5 * 9.81 * 0.005 * 0.2, abs=1e-7)
    assert found.formula_error < 1e-7


BASE = "baseline"
SPOILED = {
    "one more link": (reading("model", "links", 2), {"structure"}),
    "a wrong mass": (reading("body", "mass", 0.51), {"mass"}),
    "a start in motion": (trace(BASE, link_vel=put((0, 0, 0), 0.1)), {"start"}),
    "a run that is too short": (
        case("substeps_10", steps=21),
        {"stamps", "one_factor"},
    ),
    "another rule of stepping": (
        copied(BASE, "substeps_4"),
        {"stepped_formula", "first_order", "shrinks"},
    ),
    "a box that reaches the ground": (
        trace(BASE, link_pos=put((-2, 0, 2), 0.049)),
        {"falls", "clear_of_ground", "stepped_formula"},
    ),
    "a push from the side": (
        trace(BASE, link_pos=put((4, 0, 0), 1e-4)),
        {"straight_down"},
    ),
    "a speed that is not g t": (
        trace(BASE, link_vel=put((5, 0, 2), -0.6)),
        {"falls", "speed"},
    ),
    "one picture twice": (
        frames(initial="final", final="final", trays="final"),
        {"posture"},
    ),
    "no picture of the trays": (
        frames(initial="initial", final="final"),
        {"invisible_lid"},
    ),
    "a mesh that collides as it is drawn": (
        reading("shapes", "duck_felt", 3534),
        {"two_geometries"},
    ),
    "a duck that nothing touches": (
        reading("shapes", "duck_pieces", 0),
        {"two_geometries"},
    ),
    "a heavier box that falls faster": (
        reading("further", "heavier", 0.21),
        {"further_falls"},
    ),
    "a call on the wrong side": (
        reading(life_cycle.GROUP, "scene.step before build", 1),
        {"sides_of_build"},
    ),
}


def test_a_sound_run_passes_all_checks_and_the_lab_says_so(run):
    assert failed(run) == set()
    said = text.conclusions(replace(run, page=DROP))
    assert "` failed" not in said
    assert "The box fell 0.2011 m in 0.20 s" in said


@pytest.mark.parametrize("name", SPOILED)
def test_a_spoiled_run_fails_its_check_and_the_lab_says_which(run, name):
    spoil, names = SPOILED[name]
    spoiled = spoil(run)
    assert failed(spoiled) == names
    said = text.conclusions(spoiled)
    assert all(f"`{of}` failed" in said for of in names & text.SENTENCES.keys())


@pytest.mark.parametrize(
    ("changes", "names"),
    [({"steps": 10}, {"stamps"}), ({"height": 2.0}, {"start", "free_fall"})],
)
def test_a_changed_lab_fails_what_its_answer_says_and_meets_its_own_formula(
    run, changes, names
):
    changed = {BASE: make_drop(replace(spec.BASELINE, **changes))}
    pictures = {name: run.frames[name] for name in DROP.frames}
    lab = replace(run, page=DROP, traces=changed, frames=pictures)
    assert {check.name for check in lab.outcomes() if not check.passed} == names
    stepped = text.three_drops(lab).splitlines()[3]
    assert abs(float(stepped.split("|")[3].replace("−", "-"))) < 1e-3  # mm


def test_each_check_has_a_run_that_fails_it(run):
    fails = {name for _, names in SPOILED.values() for name in names} | {"free_fall"}
    assert fails == {check.__name__ for check in run.page.checks}


def test_figures_without_a_camera_show_what_was_measured(run):
    without = replace(run, rendered=False, frames={})
    (heights,) = plots.trays(without).axes
    assert [bar.get_height() for bar in heights.patches] == [0.0308, 0.1749]
    assert [len(plots.posture(of).axes) for of in (run, without)] == [2, 1]
