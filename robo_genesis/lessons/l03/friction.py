"""Coulomb's friction on a level surface: how far a sliding body comes, in calculus and in steps.

Nothing here knows an engine. A body slides at `speed` [m/s]; `friction` is the coefficient μ of the
pair of surfaces, dimensionless.
"""

from collections.abc import Callable, Mapping

import numpy as np

from robo_genesis.core.free_fall import GRAVITY

RULES: Mapping[str, Callable[[float, float], float]] = {
    "the larger": max,
    "the smaller": min,
    "the mean": lambda a, b: (a + b) / 2,
    "the geometric mean": lambda a, b: float(np.sqrt(a * b)),
}
"""How engines make one coefficient of two surfaces' own, by the name in a sentence."""


def coulomb_distance(speed: float, friction: float, gravity: float = GRAVITY) -> float:
    """Return v² / (2 μ g), where friction alone stops a body that slides on one face [m]."""
    return speed**2 / (2 * friction * gravity)


def coulomb_time(speed: float, friction: float, gravity: float = GRAVITY) -> float:
    """Return v / (μ g), when it has stopped [s]."""
    return speed / (friction * gravity)


def stepped_distance(speed: float, friction: float, h: float, gravity: float = GRAVITY) -> float:
    """Return what v² / (2 μ g) becomes in solver steps of length `h` [s]: v h / 2 less [m].

    Each step takes μ g h from the speed first and moves the body with what is left. That is
    semi-implicit Euler, and behind for a body that slows down as it is ahead for one that falls.
    It is the exact sum where v / (μ g h) is a whole number of steps; else the sum is longer, by up
    to μ g h² / 8.
    """
    return coulomb_distance(speed, friction, gravity) - speed * h / 2


def apparent_friction(speed: float, distance: float, gravity: float = GRAVITY) -> float:
    """Return the coefficient with which Coulomb's formula gives a measured distance [m]."""
    return speed**2 / (2 * gravity * distance)
