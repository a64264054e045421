"""Mechanical energy of a body above the surface, and the energy that semi-implicit Euler conserves.

Zero is the energy of a body at rest on the surface.
"""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.contacts import TOP, ContactCase

SHORTEST = 3
"""Smallest number of consecutive states in the air that count as a flight."""


def total_energy(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return m v² / 2 + I ω² / 2 + m g (z − z_rest) at each state, (n+1,) [J]."""
    z = trace.link_pos[:, 0, 2].astype(np.float64)
    v, w = (np.asarray(a[:, 0], np.float64) for a in (trace.link_vel, trace.link_ang))
    motion = case.mass * (v**2).sum(axis=1) + case.inertia * (w**2).sum(axis=1)
    return motion / 2 + case.mass * case.gravity * (z - case.rest_height)


def conserved_energy(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return E − m g h v_z / 2 at each state, (n+1,) [J], which semi-implicit Euler conserves.

    In one free solver step v_z changes by −g h and z by h times the new v_z, so both the total
    energy E and m g h v_z / 2 change by −m g² h² / 2. At the top of a flight v_z is zero and both
    energies are equal.
    """
    error = case.mass * case.gravity * case.h * trace.link_vel[:, 0, 2].astype(np.float64) / 2
    return total_energy(trace, case) - error


def clearance(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return the height of the body's lowest point above the surface, (n+1,) [m].

    The lowest corner of a cube follows from its orientation.
    """
    z = trace.link_pos[:, 0, 2].astype(np.float64)
    if case.shape == "ball":
        return z - case.size / 2 - TOP
    w, x, y, q = trace.link_quat[:, 0].astype(np.float64).T
    upward = np.stack([2 * (x * q - w * y), 2 * (y * q + w * x), 1 - 2 * (x**2 + y**2)])
    return z - case.size / 2 * np.abs(upward).sum(axis=0) - TOP


def flights(trace: BodyTrace, case: ContactCase) -> Iterator[slice]:
    """Yield the intervals of states in which the body is clear of the surface, in order."""
    clear = np.concatenate([[False], clearance(trace, case) > 0, [False]])
    edges = np.flatnonzero(clear[1:] != clear[:-1])
    for first, after in zip(edges[::2], edges[1::2], strict=True):
        if after - first >= SHORTEST:
            yield slice(int(first), int(after))


def kept_at_bounces(damping_ratio: float) -> float:
    """Return the share of the energy that a linear spring with damping ratio ζ returns.

    Half a period of x″ + 2 ζ ω x′ + ω² x = 0 multiplies the velocity by e^(−π ζ / √(1 − ζ²)), and
    the energy by its square. The formula neglects gravity and lets the spring pull.
    """
    return float(np.exp(-2 * np.pi * damping_ratio / np.sqrt(1 - damping_ratio**2)))
