"""The test of a student's function is one check with its name, whatever the function does."""

import numpy as np
import pytest

from robo_genesis.core import exercises


@exercises.as_test
def doubled(function, values):
    """Check `function(values)`."""
    yield from exercises.same_array("twice", function(values), 2 * values, 1e-9)


def test_a_right_function_passes_and_the_test_keeps_its_description():
    (check,) = doubled(lambda values: list(values + values), np.arange(3.0))
    assert (check.name, check.passed, check.found["twice.largest_error"]) == ("doubled", True, 0.0)
    assert doubled.__doc__ == "Check `function(values)`."


@pytest.mark.parametrize(
    ("function", "says"),
    [
        (lambda values: values, "twice.largest_error is 2, expected at most 1e-09"),
        (lambda values: values[:1], "twice.shape is 1, expected 3"),
        (lambda values: values * np.nan, "twice.largest_error is nan"),
        (lambda values: values["x"], "cannot be evaluated"),
        (lambda values: 1 / "x", "it raised TypeError"),
    ],
)
def test_a_wrong_one_fails_and_its_check_says_what_was_found(function, says):
    (check,) = doubled(function, np.arange(3.0))
    assert not check.passed
    assert says in check.detail


def test_wrong_arguments_of_the_test_itself_are_no_fault_of_the_student():
    with pytest.raises(TypeError, match="missing a required argument: 'values'"):
        doubled(lambda values: 2 * values)
