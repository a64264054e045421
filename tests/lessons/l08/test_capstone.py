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
from robo_genesis.lessons.l08 import capstone, spec, text
from robo_genesis.lessons.l08 import capstone_checks as tests

SOLVED = solutions("l08", "capstone")
SOLVED["dataclasses"] = dataclasses
CASES, OWN = capstone.CASES, capstone.CASES["own"]
RUNGS = dict.fromkeys(tests.SCENE, 1)


def rule(margin):
    """Return a rule by which failures begin this far beyond the room across the pads [m]."""

    def fails(case):
        across = np.abs(case.beliefs - case.starts)[:, 1]
        return across > (0.08 - case.size[1]) / 2 + margin

    return fails


def attempts(of, level):
    return batch(of, np.where(rule(0.004)(of), level, 7), length=10)


@pytest.fixture(scope="module")
def work(joints):
    """A run of the capstone that passes its checks."""
    runs = {name: attempts(of, 1) for name, of in CASES.items()}
    run = experiment(tests.CAPSTONE, runs, joints)
    given = {"ladder": RUNGS, "rule": {"wrong": 8}} | passed(tests.CAPSTONE)
    return replace(run, readings=run.readings | given)


def test_the_course_s_answer_is_declared_and_passes(work):
    own = replace(spec.EXACT, **SOLVED["my_object"](), starts=OWN.starts)
    own = replace(own, beliefs=SOLVED["camera"](OWN.starts))
    for name, of in CASES.items():
        found = SOLVED[name](own) if name in SOLVED else own
        assert capstone.settings_changed(found, of) == []
    assert failed(work) == set()
    _, _, row = text.attempt_table(work, "own").splitlines()
    lost = rule(0.004)(OWN).sum()
    assert (f"{64 - lost} of 64" in row, f"{lost} held" in row) == (True, True)


@pytest.mark.parametrize(
    ("change", "check"),
    [
        (reading("ladder", "seen", 0), "scene_passes"),
        (reading("rule", "wrong", 9), "rule_predicts"),
        (reading(FUNCTIONS, "fails", 0), "functions"),
        (case("without_cause", density=500.0), "changes_are_single"),
        (case("without_cause", beliefs=OWN.starts), "changes_are_single"),
        (case("without_cause", beliefs=OWN.starts + 1e-3), "changes_are_single"),
        (case("attack", starts=OWN.starts), "changes_are_single"),
    ],
)
def test_a_wrong_work_is_named(work, change, check):
    assert failed(change(work)) == {check}


@pytest.mark.parametrize(
    ("run", "like", "level", "check"),
    [
        ("own", "without_cause", 1, {"something_to_explain", "cause_is_removed"}),
        ("without_cause", "own", 1, {"cause_is_removed"}),
        ("without_rival", "without_cause", 1, {"cause_is_removed"}),
    ],
)
def test_rates_that_show_no_cause_are_named(work, run, like, level, check):
    """Nothing fails, the removal changes nothing, or the other removal helps as much."""
    of = replace(CASES[run], beliefs=CASES[like].beliefs)
    assert (
        failed(replace(work, traces={**work.traces, run: attempts(of, level)})) == check
    )


ATTACK = CASES["attack"]
EXACT = replace(ATTACK, beliefs=ATTACK.starts)


def twins(case):
    """Return a case whose starts are one new place."""
    return replace(case, starts=np.repeat(ATTACK.starts[:1], 64, axis=0))


def never(case):
    """Return that no episode fails."""
    return np.zeros(len(case.starts), bool)


@pytest.mark.parametrize(
    ("test", "function", "given", "problem"),
    [
        ("rule", rule(0.004), [ATTACK, attempts(ATTACK, 1)], ""),
        ("rule", rule(0.0), [ATTACK, attempts(ATTACK, 1)], "wrong predictions is"),
        ("rule", lambda case: True, [ATTACK, attempts(ATTACK, 1)], "type and shape"),
        ("sees", SOLVED["camera"], [], ""),
        ("sees", lambda at: at, [], "largest error"),
        ("sees", lambda at: at + 0.1, [], "believed places"),
        ("scene", SOLVED["my_object"], [RUNGS], ""),
        ("scene", SOLVED["my_object"], [RUNGS | {"built": 0}], "built is 0"),
        ("scene", dict, [RUNGS], "the course's cylinder"),
        ("change", SOLVED["without_rival"], [OWN], ""),
        ("renewed", SOLVED["without_cause"], [OWN], "distance"),
        ("renewed", twins, [OWN], "distance"),
        ("rule", never, [EXACT, attempts(EXACT, 1)], "success is"),
    ],
)
def test_each_function_is_tested(test, function, given, problem):
    found = getattr(tests, test)(function, *given)
    assert (found.passed, problem in found.detail) == (not problem, True)


def test_without_a_function_the_work_is_incomplete(capsys):
    readings = {FUNCTIONS: {"camera": 1, "fails": 0}}
    page = SimpleNamespace(experiment=SimpleNamespace(readings=readings))
    capstone.Work(page, None).finish()
    assert capsys.readouterr().out == "L08 CHECK: INCOMPLETE, not passed: fails\n"
