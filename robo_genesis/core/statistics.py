"""Rates with their intervals, two policies on the same starts, and means of few groups."""

from math import comb, sqrt
from typing import Any

import numpy as np

Z = 1.96  # Of an interval that holds in 95 % of repetitions


def wilson(successes: float, of: float, z: float = Z) -> tuple[float, float]:
    """Return the Wilson interval of a rate.

    Raises:
        ValueError: there are no episodes, or more successes than episodes.
    """
    if not 0 <= successes <= of or of < 1:
        raise ValueError(
            f"{successes} successes of {of} episodes: give 0 to n successes of n ≥ 1."
        )
    share, more = successes / of, z**2 / of
    middle = (share + more / 2) / (1 + more)
    half = z * sqrt(share * (1 - share) / of + more / (4 * of)) / (1 + more)
    return middle - half, middle + half


def paired(only_one: int, only_other: int) -> float:
    """Return the exact two-sided p value of McNemar's test.

    The arguments count the starts at which one expert succeeds alone, and the other one
    alone.
    """
    n, fewest = only_one + only_other, min(only_one, only_other)
    tail = sum(comb(n, k) for k in range(fewest + 1)) / 2**n
    return min(1.0, 2 * tail)


def of_groups(values: Any) -> tuple[float, float, float]:
    """Return the mean of independent groups' values (n,), and the ends of its 95 % interval.

    The interval is Student's, with n − 1 degrees of freedom.

    Raises:
        ValueError: there is one group, which has no spread.
    """
    from scipy.special import stdtrit

    n = len(values)
    if n < 2:
        raise ValueError(f"{n} group has no spread: give the values of two or more.")
    mean = float(np.mean(values))
    half = float(stdtrit(n - 1, 0.975) * np.std(values, ddof=1) / sqrt(n))
    return mean, mean - half, mean + half
