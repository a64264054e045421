"""Checks of the functions that a student writes in L07's lab; see `core/exercises.py`."""

import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding, equal, within
from robo_genesis.core.exercises import as_test, compared
from robo_genesis.sim.arm.reaching import ANSWERS, ONE_START
from robo_genesis.sim.bodies.table import gap

MEASURES = False

ASKED: dict[str, dict[str, Any]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text())
"""What each test asks: given values, and the right answer where no function computes it."""


@as_test
def footprints(margin: Callable[..., Any]) -> Iterator[Finding]:
    """Check `margin(one, other)`: the distance of two upright rectangles [m]."""
    for name, pair in ASKED["footprints"].items():
        for label, given in (("margin_m", pair), ("swapped_m", pair[::-1])):
            yield within(f"{name}.{label}", float(margin(*given)), gap(*given), 1e-9)


@as_test
def rest(at_rest: Callable[..., Any]) -> Iterator[Finding]:
    """Check `at_rest(positions, window, bound)` on positions (n, 3), each along each axis."""
    for name, (moves, window, bound, expected) in ASKED["rest"].items():
        for axis in range(3):
            positions = np.tile([0.5, -0.25, 0.035], (len(moves), 1))
            positions[:, axis] += moves
            yield equal(f"{name}.along_{'xyz'[axis]}", at_rest(positions, window, bound), expected)
    turns = np.array([[0, 0, 0], [0.2, 0, 0.2], [0, 0.2, 0.2]])
    yield equal("each_coordinate_for_itself", at_rest(turns, 2, 0.25), True)


@as_test
def pixels(visible: Callable[..., Any]) -> Iterator[Finding]:
    """Check `visible(segmentation, number, outline)`: pixels and share of the outline."""
    for name, (rows, number, outline) in ASKED["pixels"].items():
        count = sum(row.count(number) for row in rows)
        found = visible(np.array(rows, dtype=np.int32), number, outline)
        expected = count, count / outline if outline else 0.0
        yield from compared(name, ("pixels", "share"), found, expected, 1e-9)


@as_test
def reach(reachable: Callable[..., Any]) -> Iterator[Finding]:
    """Check `reachable(residuals, tips, touches, tolerances, clearances)` on two answers."""
    limits, least = ONE_START.tolerances, np.array([0.03, 0.02])
    zero, still = np.zeros((2, 6)), np.zeros(4, dtype=int)
    for name, (joint, residual, expected) in ANSWERS.items():
        if joint == (8, 0.1):  # the others have another fault
            for row in (0, 1):
                residuals = np.where([[row == 0], [row == 1]], residual, 0.0)
                found = reachable(residuals, least, still, limits, least)
                yield equal(f"{name}.answer_{row}", found, expected)
    for name, (heights, touches, expected) in ASKED["reach"].items():
        given = zero, np.array(heights), np.array(touches)
        yield equal(name, reachable(*given, limits, least), expected)
    for last, expected in ((-0.1, True), (-0.3, False)):
        loose = np.full((3, 6), 0.1), np.array([0.02, 0.01, last]), still, (0.2, 0.2)
        yield equal(f"third_at_{last}_m", reachable(*loose, np.array([-0.1, 0, -0.2])), expected)
    yield equal("no_answers", reachable(zero[:0], least[:0], still, limits, least[:0]), False)


@as_test
def first_failure(ladder: Callable[..., Any]) -> Iterator[Finding]:
    """Check `ladder(results)`: the first rung that fails, or None."""
    for name, (results, *expected) in ASKED["first_failure"].items():
        yield equal(name, ladder(results), expected[0] if expected else None)
