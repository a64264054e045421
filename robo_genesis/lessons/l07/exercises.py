"""Checks of the functions that a student writes in L07's lab; see `core/exercises.py`."""

from math import inf, nan
from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.exercises import (
    Written,
    as_test,
    compared,
    same_array,
)
from robo_genesis.sim.arm.reaching import ONE_START, RESIDUALS
from robo_genesis.sim.bodies.table import gap

MEASURES = False

PAIRS: dict[str, Any] = {
    "apart_along_x": ((0.0, 0.0, 0.2, 0.4), (0.5, 0.1, 0.1, 0.3)),
    "only_corners_near": ((0.1, 0.1, 0.1, 0.1), (0.21, 0.24, 0.1, 0.1)),
    "overlap_of_corners": ((0.0, 0.0, 0.2, 0.4), (0.18, -0.15, 0.2, 0.4)),
    "one_inside": ((0.5, 0.0, 1.2, 0.8), (0.4, 0.3, 0.05, 0.1)),
}


@as_test
def footprints(margin: Written) -> Findings:
    """Check `margin(one, other)`: the distance of two upright rectangles [m]."""
    for name, pair in PAIRS.items():
        for label, given in (("margin_m", pair), ("swapped_m", pair[::-1])):
            found = margin(*given)
            yield from same_array(f"{name}.{label}", found, gap(*given), 1e-9)


# Positions of one coordinate [m], window, bound [m], and whether the object is at rest
MOTIONS: dict[str, Any] = {
    "exactly_the_bound": ([0, 0, 0, 0.25, 0, 0.25], 4, 0.25, True),
    "both_ways": ([0, 0, 0, 0.1875, -0.1875, 0, 0], 4, 0.25, False),
    "creeps": ([0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7], 4, 0.25, False),
    "moved_before": ([0, 3, 7, 9, 9, 9, 9, 9], 4, 0.25, True),
    "first_step": ([0, 0, 0, 1, 1], 2, 0.25, False),
    "record_is_the_window": ([0, 0, 0], 2, 0.25, True),
    "no_states": ([], 2, 0.25, False),
    "one_state_too_short": ([0, 0], 2, 0.25, False),
    "nan": ([0, 0, nan, 0], 2, 0.25, False),
    "another_bound": ([0, 1, 0], 2, 1.0, True),
}


@as_test
def rest(at_rest: Written) -> Findings:
    """Check `at_rest(positions, window, bound)` on positions (n, 3), each along each axis."""
    for name, (moves, window, bound, expected) in MOTIONS.items():
        for axis in range(3):
            positions = np.tile([0.5, -0.25, 0.035], (len(moves), 1))
            positions[:, axis] += moves
            yield equal(
                f"{name}.along_{'xyz'[axis]}",
                at_rest(positions, window, bound),
                expected,
            )
    turns = np.array([[0, 0, 0], [0.2, 0, 0.2], [0, 0.2, 0.2]])
    yield equal("each_coordinate_for_itself", at_rest(turns, 2, 0.25), True)


# Segmentations, number of the object, area of its outline [pixel]
PICTURES: dict[str, Any] = {
    "half_hidden": ([[0, 0, 7], [7, 3, 3]], 7, 4.0),
    "absent": ([[0, 1], [2, 0]], 4, 12.5),
    "not_square": ([[5, 5, 5, 5], [1, 1, 5, 0]], 1, 3.0),
    "more_than_its_outline": ([[3, 3], [3, 0]], 3, 2.5),
    "no_outline": ([[3, 3], [0, 0]], 3, 0.0),
    "many_links": ([[7, 263], [519, 8]], 7, 4.0),
}


@as_test
def pixels(visible: Written) -> Findings:
    """Check `visible(segmentation, number, outline)`: pixels and share of the outline."""
    for name, (rows, number, outline) in PICTURES.items():
        count = sum(row.count(number) for row in rows)
        found = visible(np.array(rows, dtype=np.int32), number, outline)
        expected = count, count / outline if outline else 0.0
        yield from compared(name, ("pixels", "share"), found, expected, 1e-9)


# Heights of the fingertips at two answers [m], contacts, and whether the object is
# reachable
TIPS: dict[str, Any] = {
    "all_good": ((0.136, 0.036), (0, 0, 0, 0), True),
    "at_limits": ((0.03, 0.02), (0, 0), True),
    "first_too_low": ((0.025, 0.025), (0,), False),
    "second_too_low": ((0.2, 0.016), (0,), False),
    "second_nan": ((0.136, nan), (0, 0), False),
    "touches_last": ((1, 1), (0, 0, 2), False),
    "touches_on_the_way": ((0.136, 0.036), (0, 1, 0, 0), False),
    "touches_once": ((0.136, 0.036), (0,) * 32 + (1,), False),
}


@as_test
def reach(reachable: Written) -> Findings:
    """Check `reachable(residuals, tips, touches, tolerances, clearances)` on some answers."""
    limits, least = ONE_START.tolerances, np.array([0.03, 0.02, 0.02])
    zero, still = np.zeros((2, 6)), np.zeros(4, dtype=int)
    for name, (residual, expected) in RESIDUALS.items():
        for row in range(3):
            residuals = np.where(np.arange(3)[:, None] == row, residual, 0.0)
            found = reachable(residuals, least, still, limits, least)
            yield equal(f"{name}.answer_{row}", found, expected)
    for name, (heights, touches, expected) in TIPS.items():
        given = zero, np.array(heights), np.array(touches)
        yield equal(name, reachable(*given, limits, least[:2]), expected)
    for last, expected in ((-0.1, True), (-0.3, False)):
        loose = np.full((3, 6), 0.1), np.array([0.02, 0.01, last]), still, (0.2, 0.2)
        yield equal(
            f"third_at_{last}_m", reachable(*loose, np.array([-0.1, 0, -0.2])), expected
        )
    yield equal(
        "no_answers", reachable(zero[:0], least[:0], still, limits, least[:0]), False
    )


GOOD = {"margin": (0.171, 0.005, inf), "mass": (0.0, 0.0, 0.01)}

# Results by rung, and the first rung that fails
RESULTS: dict[str, Any] = {
    "at_limits": (
        {"b": {"x": (2, 2, 5)}, "a": {"y": (5, 2, 5), "z": (-1, -1, -1)}},
        None,
    ),
    "two_fail": (
        {"c": GOOD, "b": {"x": (4, 2, 3)}, "a": {"x": (1, 2, 3)}, "d": GOOD},
        "b",
    ),
    "first_value": ({"a": {"x": (4, 2, 3), "y": (2, 2, 3)}, "b": GOOD}, "a"),
    "negative": ({"b": {"x": (-1, 0.5, inf)}}, "b"),
    "nan": ({"c": {"x": (2, 1, 3), "y": (nan, 0, 1)}, "a": {}}, "c"),
    "nothing_measured": ({"c": GOOD, "b": {}, "a": {"x": (5, 0, 1)}}, "b"),
}


@as_test
def first_failure(ladder: Written) -> Findings:
    """Check `ladder(results)`: the first rung that fails, or None."""
    for name, (results, expected) in RESULTS.items():
        yield equal(name, ladder(results), expected)
