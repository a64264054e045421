"""Findings and their judgement, the factories of checks, and the outcome of a check."""

import json
from dataclasses import dataclass

import numpy as np
import pytest
import torch

from robo_genesis.core import checks
from robo_genesis.core.check_spec import MASS_SHARE


@pytest.mark.parametrize(
    ("finding", "passed", "problem"),
    [
        (checks.equal("x", 3, 4), False, "x is 3, expected 4"),
        (checks.equal("x", ("a", "b"), ["a", "b"]), True, None),
        (checks.equal("x", np.nan, None), False, "x is nan, expected None"),
        (checks.equal("x", np.float32(0), 0.0), True, None),
        (checks.equal("x", "1", 1), False, "x is '1' (str), expected 1"),
        (checks.equal("x", [True], True), False, "x is [True] (list), expected True"),
        (checks.equal("x", [], ["a"]), False, "x is nothing, expected a"),
        (checks.within("x", 1.5, 1.0, 0.5), True, None),
        (checks.within("x", 1.6, 1.0, 0.5), False, "x is 1.6, expected 1 ± 0.5"),
        (
            checks.within("x", 0.50000001, 0.5, 1e-9),
            False,
            "x is 0.50000001 (float), expected 0.5 ± 1e-09",
        ),
        (
            checks.within("x", None, 1.0, 0.5),
            False,
            "x is None, expected 1 ± 0.5",
        ),
        (checks.at_most("x", 2.0, 2.0), True, None),
        (checks.at_most("x", 2.1, 2.0), False, "x is 2.1, expected at most 2"),
        (checks.below("x", 1.9, 2.0), True, None),
        (checks.below("x", 2.0, 2.0), False, "x is 2.0 (float), expected less than 2"),
        (checks.above("x", 2.1, 2.0), True, None),
        (checks.above("x", 2.0, 2.0), False, "x is 2.0 (float), expected more than 2"),
        (checks.above("x", np.nan, 2.0), False, None),
        (checks.noted("x", -7.0), True, None),
    ],
)
def test_a_finding_is_judged_and_says_found_and_allowed(finding, passed, problem):
    assert finding.passed is passed
    assert problem in (None, finding.problem)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (np.int32(4), 4),
        (np.float32(0.5), 0.5),
        (np.bool_(False), False),
        (np.inf, "inf"),
        (np.arange(3), "0, 1, 2"),
        (("a", "b"), "a, b"),
        (torch.tensor(True), True),
        ({1}, "{1}"),
    ],
)
def test_a_value_becomes_one_that_json_can_hold(value, expected):
    found = checks.plain(value)
    assert (type(found), found) == (type(expected), expected)


def test_an_outcome_is_recorded_without_words_and_without_allowed_values():
    def near(limit):
        """The distance is small."""
        yield checks.at_most("distance_m", np.float32(0.5), limit)
        yield checks.equal("difference of two cases", ["kp"], ["kp"], recorded=False)

    (strict,), (loose,) = (checks.evaluate([near], limit) for limit in (0.1, 1.0))
    assert (strict.passed, loose.passed) == (False, True)
    assert strict.detail == "distance_m is 0.5, expected at most 0.1"
    assert loose.detail == "The distance is small."
    record = {"name": "near", "passed": True, "found": {"distance_m": 0.5}}
    assert json.loads(json.dumps(loose.record())) == record
    assert strict.record() == record | {"passed": False}


def test_a_check_that_breaks_off_fails_and_keeps_what_it_found():
    def broken(subject):
        """There is a second one."""
        yield checks.noted("first", 1)
        yield checks.noted("second", subject["second"])

    (outcome,) = checks.evaluate([broken], {})
    assert not outcome.passed
    assert outcome.found == {"first": 1}
    assert outcome.detail == "cannot be evaluated: KeyError('second')"


def test_a_check_that_finds_nothing_fails():
    nothing = checks.Check("empty", False, "nothing was found")
    assert checks.conclude("empty", "Something is there.", []) == nothing


def test_two_findings_need_two_labels():
    outcome = checks.conclude("twice", "", [checks.noted("a", 1), checks.noted("a", 2)])
    assert not outcome.passed
    assert outcome.detail == "labels are repeated: a. Give each finding its own"


@dataclass(frozen=True)
class Case:
    steps: int = 4
    dt: float = 0.5
    size: float = 1.0


def counts(**found):
    return checks.model_counts(found, {"links": 1, "joints": 2})


def mass(found):
    return checks.masses(found, {"cube": 2.0})


@pytest.mark.parametrize(
    ("findings", "labels"),
    [
        (counts(links=1, joints=2), []),
        (counts(links=1, joints=3), ["joints"]),
        (counts(links=1), ["joints"]),
        (counts(links=1, joints=2, lids=1), ["lids"]),
        (mass({"cube": 2 * (1 + 0.9 * MASS_SHARE)}), []),
        (mass({"cube": 2 * (1 + 1.1 * MASS_SHARE)}), ["cube.mass_kg"]),
        (mass({}), ["cube.mass_kg"]),
    ],
)
def test_a_shared_check_names_each_value_that_is_not_allowed(findings, labels):
    assert [finding.label for finding in findings if not finding.passed] == labels


@pytest.mark.parametrize(
    ("other", "passed"),
    [(Case(steps=8), True), (Case(), False), (Case(steps=8, dt=0.25), False)],
)
def test_compared_cases_differ_in_the_given_fields_alone(other, passed):
    pairs = {("one", "other"): ["steps"]}
    (finding,) = checks.factors({"one": Case(), "other": other}, pairs)
    assert isinstance(finding, checks.Finding)
    assert (finding.passed, finding.recorded) == (passed, False)
