"""Intervals and a p value that others publish or that follow by hand."""

import numpy as np
import pytest

from robo_genesis.core import statistics


@pytest.mark.parametrize(
    ("k", "n", "low", "high"),
    [
        (1, 1, 0.207, 1.0),
        (64, 64, 0.943, 1.0),
        (256, 256, 0.985, 1.0),
        (0, 10, 0.0, 0.278),
        (15, 16, 0.717, 0.989),
    ],
)
def test_wilson_intervals_that_others_publish(k, n, low, high):
    assert statistics.wilson(k, n) == pytest.approx((low, high), abs=6e-4)


def test_the_paired_test_is_exact():
    assert statistics.paired(0, 5) == pytest.approx(2 / 32)
    assert statistics.paired(3, 3) == 1.0
    assert statistics.paired(1, 22) == statistics.paired(22, 1)


@pytest.mark.parametrize(
    ("good", "mean", "half"),
    [((6, 8, 7, 9, 5, 8, 7, 6), 0.4375, 0.0684), ((4, 4), 0.25, 0), ((0, 16), 0.5, 6.3531)],
)  # fmt: skip
def test_the_interval_of_a_mean_of_groups_is_students(good, mean, half):
    right = mean, mean - half, mean + half
    assert statistics.of_groups(np.array(good) / 16) == pytest.approx(right, abs=6e-5)


def test_one_group_has_no_interval():
    with pytest.raises(ValueError, match="1 group"):
        statistics.of_groups([0.5])
