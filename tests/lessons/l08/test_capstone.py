"""The capstone's checks and function tests name what is wrong in a student's work."""

import dataclasses
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from lessons.changed_runs import case, failed, passed, reading
from lessons.exercise_cells import solutions
from lessons.l08.conftest import batch, experiment

from robo_genesis.core.exercises import FUNCTIONS
from robo_genesis.lessons.l08 import capstone, plots, spec, text
from robo_genesis.lessons.l08 import capstone_checks as tests
from robo_genesis.lessons.l08.capstone_checks import CAPSTONE

SOLVED = solutions("l08", "capstone")
SOLVED["dataclasses"] = dataclasses
OWN, ATTACK = (capstone.CASES[name] for name in ("own", "attack"))
RUNGS = dict.fromkeys(tests.SCENE, 1)
EDGE = 11e-3  # Error across the pads from which an episode fails here [m]


def level(case):
    """Return how many rungs each episode of a case reaches."""
    return np.where(np.abs(case.beliefs - case.starts)[:, 1] > EDGE, 1, 7)


@pytest.fixture(scope="module")
def work(joints):
    """A run of the capstone that passes its checks."""
    runs = {n: batch(of, level(of), length=10) for n, of in capstone.CASES.items()}
    run = experiment(CAPSTONE, runs, joints)
    given = {"ladder": RUNGS, "rule": {"wrong": 1}} | passed(CAPSTONE)
    return replace(run, readings=run.readings | given)


def test_the_declared_runs_are_those_of_the_page_s_answer():
    own = replace(spec.EXACT, **SOLVED["my_object"](), starts=OWN.starts)
    own = replace(own, beliefs=SOLVED["camera"](OWN.starts))
    assert capstone.settings_changed(own, OWN) == []
    for name in ("without_cause", "without_rival", "attack"):
        found, declared = SOLVED[name](own), capstone.CASES[name]
        assert capstone.settings_changed(found, declared) == []


def test_the_course_s_answer_passes(work):
    assert failed(work) == set()
    rows = text.attempt_table(work, "own", "without_cause").splitlines()
    lost = (level(OWN) == 1).sum()
    assert f"{64 - lost} of 64" in rows[2]
    assert f"{lost} held" in rows[2]
    assert "64 of 64" in rows[3]
    labels = plots.failures(work, "own").axes[0].get_legend_handles_labels()[1]
    assert labels == ["held", "success"]


EXACT = {"beliefs": OWN.starts}

# A change of the work, and the check that fails
WRONG = {
    "a rung fails": (reading("ladder", "seen", 0), "scene_passes"),
    "the rule errs": (reading("rule", "wrong", 9), "rule_predicts"),
    "the rule errs in one of eight": (reading("rule", "wrong", 8), None),
    "two settings are changed": (
        case("without_cause", density=500.0),
        "changes_are_single",
    ),
    "all places are exact": (case("without_cause", **EXACT), "changes_are_single"),
    "the starts are changed": (
        case("without_rival", beliefs=OWN.beliefs, starts=OWN.starts + 1e-6),
        "changes_are_single",
    ),
    "both changes are one": (
        case("without_rival", beliefs=capstone.CASES["without_cause"].beliefs),
        "changes_are_single",
    ),
    "old starts": (case("attack", starts=OWN.starts), "changes_are_single"),
    "a function is missing": (reading(FUNCTIONS, "fails", 0), "functions"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_work_is_named(work, name):
    change, check = WRONG[name]
    assert failed(change(work)) == ({check} if check else set())


@pytest.mark.parametrize(
    ("own", "without_cause", "check"),
    [
        (7, 7, {"something_to_explain", "cause_is_removed"}),
        (1, 7, {"something_to_explain"}),
        (None, None, {"cause_is_removed"}),
    ],
)
def test_rates_that_show_no_cause_are_named(work, own, without_cause, check):
    """All succeed, all fail, or the removal changes nothing."""
    found = {}
    for name, reached in (("own", own), ("without_cause", without_cause)):
        of = capstone.CASES[name]
        every = level(OWN) if reached is None else np.full(64, reached)
        found[name] = batch(of, every, length=10)
    assert failed(replace(work, traces={**work.traces, **found})) == check


def rule(margin):
    """Return a rule whose failures begin this far beyond the room [m]."""

    def fails(case):
        across = np.abs(case.beliefs - case.starts)[:, 1]
        return across > (0.08 - case.size[1]) / 2 + margin

    return fails


@pytest.mark.parametrize(
    ("fails", "problem"),
    [
        (rule(0.004), ""),
        (rule(0.0), "wrong predictions is"),
        (lambda case: np.zeros(64, bool), "wrong predictions is"),
        (lambda case: np.zeros(64), "type and shape is"),
        (lambda case: True, "type and shape is"),
    ],
)
def test_a_rule_is_tested_on_new_episodes(work, fails, problem):
    """The room alone, a constant, and what is no truth value for each episode are refused."""
    found = tests.rule(fails, ATTACK, work.traces["attack"])
    assert (found.passed, problem in found.detail) == (not problem, True)


@pytest.mark.parametrize(
    ("camera", "problem"),
    [
        (SOLVED["camera"], ""),
        (lambda places: places, "largest error"),
        (lambda places: places + 0.1, "believed places"),
        (lambda places: places[0], "shape"),
        (lambda places: places + np.random.default_rng().normal(0, 5e-3, places.shape), "again"),
        (lambda places: np.array(spec.turned(places, 4.0)), "turned camera"),
    ],
)
def test_a_camera_errs_by_a_possible_amount(camera, problem):
    found = tests.sees(camera)
    assert (found.passed, problem in found.detail) == (not problem, True)


@pytest.mark.parametrize(
    ("changed", "rungs", "problem"),
    [
        ({}, RUNGS, ""),
        ({}, RUNGS | {"built": 0}, "built is 0"),
        ({"shape": "cylinder", "size": spec.EXACT.size}, RUNGS, "the course's cylinder"),
        ({"mass": 1.0}, RUNGS, "TypeError"),
    ],
)
def test_an_object_is_another_one_and_passes_the_ladder(changed, rungs, problem):
    found = tests.scene(lambda: SOLVED["my_object"]() | changed, rungs)
    assert (found.passed, problem in found.detail) == (not problem, True)


def test_changes_and_attacks_are_tested_when_they_are_written():
    cause, rival = (SOLVED[name] for name in ("without_cause", "without_rival"))
    assert tests.change(cause, OWN).passed
    assert tests.change(rival, OWN, cause(OWN)).passed
    assert not tests.change(cause, OWN, cause(OWN)).passed
    assert not tests.change(lambda case: case, OWN).passed
    assert tests.renewed(SOLVED["attack"], OWN).passed
    assert not tests.renewed(cause, OWN).passed


@pytest.fixture
def scenes(monkeypatch):
    """The sizes of the objects for which a scene is built; nothing runs."""
    built = []
    world = SimpleNamespace(robot=None, scene=SimpleNamespace(reset=list), cameras={"world": 0})
    done = "the run", SimpleNamespace(trace=lambda row: "one episode")
    monkeypatch.setattr(capstone.picking, "build", lambda gs, of, view: built.append(of) or world)
    monkeypatch.setattr(capstone.picking, "run", lambda *given: done)
    monkeypatch.setattr(capstone, "describe", lambda page, robot: None)
    return built


def opened(functions):
    """A page with these functions, passed or not, and its own copy of the declared runs."""
    declared = SimpleNamespace(runs=dict(CAPSTONE.runs))
    run = SimpleNamespace(page=declared, readings={FUNCTIONS: functions})
    return SimpleNamespace(
        experiment=run,
        traces={},
        links=["hand"],
        capture=lambda camera, name: None,
        finish=lambda scene: print("PASSED"),
    )


def test_chosen_cases_replace_the_declared_ones_and_share_a_scene(scenes):
    page = opened({})
    work, small = capstone.Work(page, None), replace(OWN, size=(0.03, 0.03, 0.06))
    for name, of in (("own", small), ("without_cause", replace(small, beliefs=OWN.starts))):
        work.run(name, of)
        assert page.experiment.page.runs[name].case is of
    assert page.experiment.page.runs["first"].case.size == small.size
    work.run("attack", OWN)
    assert scenes == [small, OWN]
    assert {*page.traces} == {"first", "own", "without_cause", "attack"}


@pytest.mark.parametrize(
    ("functions", "said"),
    [
        ({"my_object": 1, "fails": 1}, "PASSED"),
        ({"my_object": 0, "fails": 0}, "L08 CHECK: INCOMPLETE, not passed: my_object, fails"),
    ],
)
def test_a_work_without_functions_is_incomplete(scenes, capsys, functions, said):
    work = capstone.Work(opened(functions), None)
    if functions["fails"]:
        work.run("own", OWN)
    work.finish()
    assert capsys.readouterr().out.strip() == said
