"""Rungs and checks of L07: known values, and each check with an input that breaks its claim."""

from types import SimpleNamespace

import pytest
from lessons.changed_runs import failed, put, reading, shift, trace
from lessons.experiments import each

from robo_genesis.lessons.l07 import checks, plots, rungs, spec, text
from robo_genesis.lessons.l07.metrics import BALL, OBJECT


def test_an_object_that_both_cameras_lose_is_not_seen(scenes):
    for camera in rungs.CAMERAS:
        scenes = reading("pixels", f"baseline_{camera}", 150.0)(scenes)
    assert rungs.failed(scenes, "baseline") == ["seen"]


def test_the_checks_accept_the_scenes_and_each_fails_one_rung(scenes):
    assert failed(scenes) == set()
    assert rungs.failed(scenes, "baseline") == []
    assert (
        text.ladder_table(scenes).count("**fails**") == len(spec.SCENES_OF_LECTURE) - 1
    )
    for figure in (plots.settling, plots.lifts, plots.views):
        assert figure(scenes).axes


# By check, changes that break its claim
SPOILED = {
    "structure": [reading("model", "links", 10)],
    "stamps": [trace("baseline", t=lambda t: 2 * t)],
    "one_rung": [
        reading("object", "baseline_depth", 2e-3),
        reading("object", "baseline_mass", 0.2),
        trace("baseline_at_rest", link_pos=put((-1, BALL, 0), 0.9)),  # beside the bowl
        trace("baseline_at_rest", link_pos=shift((-1, OBJECT, 0), 4e-4)),  # it slides
        reading("reach", "baseline_accepted", 1),
        reading("reach", "baseline_grasp", 0.01),
        reading("reach", "baseline_touches", 1),
        reading("contacts", "baseline_descending", 1),
        reading("contacts", "baseline_held_left", 0),
        trace("baseline", link_pos=shift((-1, OBJECT, 2), -0.02)),  # it slips
        reading("fails", "hovering", 3),
    ],
    "hovering_is_at_rest": [
        trace("hovering_at_rest", link_pos=shift((-1, OBJECT, 2), -1e-5))
    ],
    "lifted_though_too_wide": [
        trace("forced_fine", link_pos=shift((-1, OBJECT, 2), -0.02)),  # it slips
        trace("forced", link_quat=put((-1, OBJECT, 1), 0)),  # upright
        reading("contacts", "forced_fine_descending", 0),
        reading("contacts", "forced_held_right", 0),
    ],
}


@pytest.mark.parametrize(("check", "spoil"), each(SPOILED))
def test_a_check_fails_for_its_own_fault(scenes, check, spoil):
    assert failed(spoil(scenes)) == {check}


@pytest.mark.parametrize(
    "wrong", [None, "outside", "accepted", "touches", "descending"]
)
def test_the_symptoms_of_the_scenes(wrong):
    readings = {
        "pixels": {"outside_wrist": 1.0 * (wrong == "outside"), "wide_wrist": 9.0},
        "reach": {
            "below_accepted": 2 - (wrong == "accepted"),
            "below_touches": wrong != "touches",
        },
        "contacts": {"wide_descending": wrong != "descending"},
    }
    found = checks.symptoms(SimpleNamespace(readings=readings))
    assert all(one.passed for one in found) is (wrong is None)
