"""The test of a student's function is one check with its name, whatever the function does."""

import numpy as np
import pytest
import torch

from robo_genesis.core import exercises


def raises(values):
    return [*values][3]


def doubles(values):
    values *= 2
    return values


@exercises.as_test
def doubled(function, values):
    """Check `function(values)`."""
    yield from exercises.same_array("twice", function(values), 2 * values, 1e-9)


def test_a_right_function_passes_and_the_test_keeps_its_description():
    for kind in (np.float64, np.float32):
        check = doubled(lambda of, kind=kind: list(kind(of + of)), np.arange(3) / 10)
        assert (check.name, check.passed) == ("doubled", True)
    assert doubled.__doc__ == "Check `function(values)`."


@pytest.mark.parametrize(
    ("function", "says"),
    [
        (
            lambda values: values,
            "([0, 1, 2]) returned [0, 1, 2]\n"
            "  twice[1], the first that differs, is 1, expected 2 ± 1e-09",
        ),
        (lambda values: values[:1], "twice.shape is (1,), expected (3,)"),
        (lambda values: ["0", "2", "4"], "twice is ['0', '2', '4'], expected numbers"),
        (lambda values: None, "returned None\n  twice is None, expected numbers"),
        (
            doubles,
            "doubles([0, 1, 2]) returned [0, 2, 4]\n  It changed its argument values.",
        ),
        (
            raises,
            "raises([0, 1, 2]): IndexError: list index out of range\n  line 11 of its cell",
        ),
    ],
)
def test_a_wrong_one_fails_and_its_check_says_what_was_found(function, says):
    check = doubled(function, np.arange(3.0))
    assert not check.passed
    assert says in check.detail


def test_the_first_wrong_row_is_named_with_what_it_should_be():
    given = np.arange(12.0).reshape(4, 3)
    check = doubled(lambda values: 2 * values + 0.5 * np.isin(values, (7, 11)), given)
    says = "twice[2], the first that differs, is [12, 14.5, 16], expected [12, 14, 16]"
    assert says in check.detail


class Drawn:
    def __repr__(self):
        return "───\n a picture of a scene"


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ({"b": {"x": (4, 2.5)}, "a": {}}, "{'b': {'x': (4, 2.5)}, 'a': {}}"),
        (np.arange(16), "[ 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]"),
        (np.arange(1000.0), "[0, 1, 2, ..., 997, 998, 999]"),
        ([np.float32(0.5), None], "[0.5, None]"),
        (Drawn(), "<Drawn>"),
    ],
)
def test_a_message_shows_the_whole_of_a_short_input(value, words):
    assert exercises.brief(value) == words


@exercises.as_test
def counted(function, given):
    """Check `function(given)` twice with the same argument."""
    for label in ("first", "again"):
        yield from exercises.same_array(label, function(given), 0.1, 1e-9)


@pytest.mark.parametrize(
    ("function", "says"),
    [
        (lambda given: given["a"][0], ""),
        (lambda given: np.float32(given["a"][0]), ""),
        (lambda given: torch.tensor(given["a"]), ""),
        (lambda given: given["a"].pop(), "It changed its argument given. Use a copy."),
        (lambda given: 0.10000001, "first is 0.10000001 (float), expected 0.1 ± 1e-09"),
    ],
)
def test_a_function_gets_copies_and_returns_a_number(function, says):
    check = counted(function, {"a": [0.1]})
    assert (check.passed, says in check.detail) == (not says, True)
