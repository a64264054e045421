"""Coulomb friction on a level surface: how far a sliding body travels, in calculus and in steps.

A body slides at `speed` [m/s]; `friction` is the dimensionless coefficient μ of the two surfaces.
"""

from collections.abc import Callable, Mapping

import numpy as np

from robo_genesis.core.free_fall import GRAVITY
from robo_genesis.sim.bodies.contacts import ContactCase

RULES: Mapping[str, Callable[[float, float], float]] = {
    "the larger": max,
    "the smaller": min,
    "the mean": lambda a, b: (a + b) / 2,
    "the geometric mean": lambda a, b: float(np.sqrt(a * b)),
}
"""The rules by which engines combine the coefficients of two surfaces, by their names in a text."""


def pair_friction(case: ContactCase) -> float:
    """Return the coefficient μ of body and surface by the engine's rule, the larger of the two."""
    return max(case.friction, case.surface_friction)


def coulomb_distance(speed: float, friction: float, gravity: float = GRAVITY) -> float:
    """Return v² / (2 μ g), the distance after which friction stops a sliding body [m]."""
    return speed**2 / (2 * friction * gravity)


def coulomb_time(speed: float, friction: float, gravity: float = GRAVITY) -> float:
    """Return v / (μ g), the time after which it stops [s]."""
    return speed / (friction * gravity)


def stepped_distance(speed: float, friction: float, h: float, gravity: float = GRAVITY) -> float:
    """Return v² / (2 μ g) − v h / 2, the same distance in solver steps of length `h` [s]: [m].

    Each step first takes μ g h from the speed and then moves the body with the new speed, as
    semi-implicit Euler does. It is behind the continuous solution for a body that slows down, and
    ahead of it for a body that falls. The formula is the exact sum where v / (μ g h) is a whole
    number of steps; otherwise the sum is longer by up to μ g h² / 8.
    """
    return coulomb_distance(speed, friction, gravity) - speed * h / 2


def apparent_friction(speed: float, distance: float, gravity: float = GRAVITY) -> float:
    """Return the coefficient for which Coulomb's formula gives a measured distance [m]."""
    return speed**2 / (2 * gravity * distance)
