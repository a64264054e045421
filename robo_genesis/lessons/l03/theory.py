"""Formulas of a contact as a linear spring and damper, and of Coulomb's friction on it.

At a damping ratio of one, a contact with time constant T gives a body the acceleration
−(2 / T) v − x / T², and it never pulls. Gravity is neglected while the two overlap. A
sliding body has the speed v of its case and the friction coefficient μ of the pair.
"""

from collections.abc import Callable, Mapping

import numpy as np

from robo_genesis.sim.bodies import soft_contact
from robo_genesis.sim.bodies.contacts import ContactCase

# The rules by which engines combine the coefficients of two surfaces, by their names in
# a text.
RULES: Mapping[str, Callable[[float, float], float]] = {
    "the larger": max,
    "the smaller": min,
    "the mean": lambda a, b: (a + b) / 2,
    "the geometric mean": lambda a, b: np.sqrt(a * b),
}


def pair_friction(case: ContactCase) -> float:
    """Return the coefficient μ of body and surface by the engine's rule, the larger of the two."""
    return max(case.friction, case.surface_friction)


def coulomb_distance(case: ContactCase) -> float:
    """Return v² / (2 μ g), the distance after which friction stops a sliding body [m]."""
    return case.speed**2 / (2 * pair_friction(case) * case.gravity)


def stepped_distance(case: ContactCase) -> float:
    """Return v² / (2 μ g) − v h / 2, the same distance in solver steps of length h [m].

    Each step first takes μ g h from the speed and then moves the body with the new
    speed, as semi-implicit Euler does. It is behind the continuous solution for a body
    that slows down, and ahead of it for a body that falls. The formula is the exact sum
    where v / (μ g h) is a whole number of steps; otherwise the sum is longer by up to μ
    g h² / 8.
    """
    return coulomb_distance(case) - case.speed * case.h / 2


def apparent_friction(case: ContactCase, distance: float) -> float:
    """Return the coefficient for which Coulomb's formula gives a measured distance [m]."""
    return case.speed**2 / (2 * case.gravity * distance)


def kept_at_bounces(damping_ratio: float) -> float:
    """Return the share of the energy that a linear spring with damping ratio ζ returns.

    Half a period of x″ + 2 ζ ω x′ + ω² x = 0 multiplies the velocity by e^(−π ζ / √(1 −
    ζ²)), and the energy by its square. The formula neglects gravity and lets the spring
    pull.
    """
    return np.exp(-2 * np.pi * damping_ratio / np.sqrt(1 - damping_ratio**2))


def contact_seconds(case: ContactCase) -> float:
    """Return the time constant T that is in force in a case without a spring of its own [s]."""
    return soft_contact.time_constant(case.h, case.time_constant)


def impact_speed(case: ContactCase) -> float:
    """Return √(2 g z), the speed at which a dropped body meets the surface [m/s]."""
    return np.sqrt(2 * case.gravity * (case.start[2] - case.rest_height))


def depth(case: ContactCase) -> float:
    """Return v T / e, the largest depth of a body that lands with speed v [m].

    From x(0) = 0 and ẋ(0) = v follows x = v t e^(−t / T), which is largest at t = T.
    """
    return impact_speed(case) * contact_seconds(case) / np.e


def first_depth(case: ContactCase) -> float:
    """Return the depth at the end of the first solver step that ends below the surface [m].

    After n steps without contact a body has fallen by g h² n (n + 1) / 2.
    """
    drop, unit = case.start[2] - case.rest_height, case.gravity * case.h**2 / 2
    n = np.ceil((np.sqrt(1 + 4 * drop / unit) - 1) / 2)
    return unit * n * (n + 1) - drop


def release_speed(case: ContactCase) -> float:
    """Return v e⁻², the upward speed at which the contact stops pushing [m/s].

    The force (v / T) e^(−t / T) (2 − t / T) is zero at t = 2 T.
    """
    return impact_speed(case) * np.exp(-2)


def rebound(case: ContactCase) -> float:
    """Return how high a body rises above the surface after its release, 0 where it does not [m].

    At its release it is 2 v T e⁻² below the surface.
    """
    at_release = 2 * impact_speed(case) * contact_seconds(case) * np.exp(-2)
    return max(0.0, release_speed(case) ** 2 / (2 * case.gravity) - at_release)


def upward_blow(case: ContactCase) -> float:
    """Return the upward speed that one solver step gives a pushed body with the pyramid [m/s].

    Of each contact's edges, the one against the motion has the speed −μ v. Its damper
    removes the share 2 h / T of it in one step, along a direction in which a force
    changes the speed by (1 + μ²) times the upward part.
    """
    mu = pair_friction(case)
    return 2 * case.h / contact_seconds(case) * mu * case.speed / (1 + mu**2)


def hop(case: ContactCase) -> float:
    """Return u² / (2 g), the height to which `upward_blow` throws a body [m]."""
    return upward_blow(case) ** 2 / (2 * case.gravity)
