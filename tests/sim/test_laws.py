import numpy as np
import pytest

from robo_genesis.sim.laws import apart, kept


@pytest.mark.parametrize(
    ("found", "tolerance", "broken"),
    [
        ([1.0, 2.0], np.array([1.0, 2.0]), False),
        ([1.0, 2.1], np.array([1.0, 2.0]), True),
        ([1.0, np.nan], 2.0, True),
        ([], 0.0, False),
    ],
)
def test_a_law_is_broken_beyond_its_tolerance(found, tolerance, broken):
    breaches = [*apart("x", np.array(found), np.zeros(1), tolerance)]
    assert [breach.passed for breach in breaches] == [False] * broken


def test_a_check_names_the_first_law_that_a_run_breaks_and_the_entry_farthest_off():
    rows = np.array([[0.0, 0.2], [0.5, 0.0]])
    (wrong,) = kept("G1", apart("effort [N·m]", rows, np.zeros(()), 0.1))
    assert (
        wrong.problem == "G1: effort [N·m] at index [1, 0] is 0.5, expected 0.0 ± 0.1"
    )
    assert (wrong.passed, wrong.recorded) == (False, False)
    (right,) = kept("G1", apart("effort [N·m]", rows, np.zeros(()), 0.5))
    assert right.passed
