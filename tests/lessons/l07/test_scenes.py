"""Rungs and checks of L07: known values, and each check with an input that breaks its claim."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from lessons.changed_runs import failed, put, reading, shift, trace
from lessons.experiments import each

from robo_genesis.lessons.l07 import plots, rungs, spec, study, text
from robo_genesis.lessons.l07.metrics import OBJECT
from robo_genesis.sim.bodies import table
from robo_genesis.sim.session import CaseError


def test_one_camera_must_fulfil_both_bounds():
    assert rungs.best([(5416, 0.449), (4341, 0.998)]) == (4341, 0.998)
    assert rungs.best([(150, 1.0), (900, 0.4)]) == (900, 0.4)


# By words: what differs from the good scene, and whether some pair then overlaps
PLACES = {
    "as it is": ({}, False),
    "half over the edge": ({"place": (0.5, -0.39, 0.0)}, True),
    "off the shelf": ({"place": (0.5, -0.05, 0.1), "size": (0.2, 0.05, 0.07)}, True),
    "above the bowl": ({"place": (0.55, 0.22, 0.1)}, False),
    "in the shelf's height": ({"place": (0.55, 0.22, 0.06)}, True),
    "inside the table": ({"gap": -2e-3}, True),
    "bowl over the edge": ({"bowl_at": (1.0, 0.0)}, True),
}


@pytest.mark.parametrize("name", PLACES)
def test_all_that_shares_a_height_needs_a_margin(name):
    changed, overlap = PLACES[name]
    boxes = replace(spec.GOOD, **changed).boxes
    assert (min(table.gap(*pair) for pair in rungs.pairs(boxes)) < 0) == overlap


def test_a_thin_ball_is_refused():
    thin = replace(spec.GOOD, ball_radius=0.0)
    with pytest.raises(CaseError, match="ball_radius"):
        study.Facts(SimpleNamespace(), None, thin)


def test_the_checks_accept_the_scenes_and_each_fails_one_rung(scenes):
    assert failed(scenes) == set()
    assert rungs.failed(scenes, "baseline") == []
    assert (
        text.ladder_table(scenes).count("**fails**") == len(spec.SCENES_OF_LECTURE) - 1
    )
    assert text.attack_table(scenes).count("margin") == 4
    for figure in (plots.lifts, plots.views):
        assert figure(scenes).axes


PENCIL = next(name for name, (_, of) in spec.ATTACKS.items() if of == "pushed")

# By check, changes that break its claim
SPOILED = {
    "structure": [reading("model", "links", 10)],
    "stamps": [trace("baseline", t=lambda t: 2 * t)],
    "one_rung": [
        *(reading("ladder", f"baseline_{name}", -1e9) for name in spec.LIMITS),
        reading("fails", "hovering", 3),
    ],
    "attacks_are_caught": [
        reading("attacks", PENCIL, 0),
        reading("attacks", [*spec.ATTACKS][-1], 5),
        reading("caught", PENCIL, 1e-3),
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


@pytest.mark.engine
@pytest.mark.slow
def test_verdicts_hold_at_half_the_step(real_engine, monkeypatch):
    monkeypatch.setattr(spec, "GOOD", replace(spec.GOOD, substeps=4))
    page = SimpleNamespace(render=True, readings={})
    study.attack(page, real_engine.gs, {})
    verdicts = page.readings["attacks"]
    for name, (_, quantity) in spec.ATTACKS.items():
        rung = rungs.rung_of(quantity) if quantity else None
        assert verdicts[name] == rungs.NUMBERS.index(rung), name
