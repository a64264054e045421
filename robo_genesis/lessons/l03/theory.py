"""A contact as a linear spring and damper: depth, release, rebound, and the hop of one step.

At a damping ratio of one, a contact with time constant T gives a body the acceleration
−(2 / T) v − x / T², and it never pulls. Gravity is neglected while the two overlap.
"""

import numpy as np

from robo_genesis.lessons.l03.friction import pair_friction
from robo_genesis.sim.bodies.contacts import ContactCase
from robo_genesis.sim.mujoco import contacts as mujoco_contacts


def contact_seconds(case: ContactCase) -> float:
    """Return the time constant T that is in force in a case without a spring of its own [s]."""
    return mujoco_contacts.time_constant(case.h, case.time_constant)


def impact_speed(case: ContactCase) -> float:
    """Return √(2 g z), the speed at which a dropped body meets the surface [m/s]."""
    return float(np.sqrt(2 * case.gravity * (case.start[2] - case.rest_height)))


def depth(case: ContactCase) -> float:
    """Return v T / e, the largest depth of a body that lands with speed v [m].

    From x(0) = 0 and ẋ(0) = v follows x = v t e^(−t / T), which is largest at t = T.
    """
    return impact_speed(case) * contact_seconds(case) / float(np.e)


def release_speed(case: ContactCase) -> float:
    """Return v e⁻², the upward speed at which the contact stops pushing [m/s].

    The force (v / T) e^(−t / T) (2 − t / T) is zero at t = 2 T.
    """
    return impact_speed(case) * float(np.exp(-2))


def rebound(case: ContactCase) -> float:
    """Return how high a body rises above the surface after its release, 0 where it does not [m].

    At its release it is 2 v T e⁻² below the surface.
    """
    at_release = 2 * impact_speed(case) * contact_seconds(case) * float(np.exp(-2))
    return max(0.0, release_speed(case) ** 2 / (2 * case.gravity) - at_release)


def upward_blow(case: ContactCase) -> float:
    """Return the upward speed that one solver step gives a pushed body with the pyramid [m/s].

    Of each contact's edges, the one against the motion has the speed −μ v. Its damper removes the
    share 2 h / T of it in one step, along a direction in which a force changes the speed by
    (1 + μ²) times the upward part.
    """
    mu = pair_friction(case)
    return 2 * case.h / contact_seconds(case) * mu * case.speed / (1 + mu**2)


def hop(case: ContactCase) -> float:
    """Return u² / (2 g), the height to which `upward_blow` throws a body [m]."""
    return upward_blow(case) ** 2 / (2 * case.gravity)
