"""The state of a body on a surface after one outer step, by the contact model of both engines.

Where the body only moves up and down, the model is one formula; everywhere else MuJoCo computes the
state.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.arm.kinematics import rotate
from robo_genesis.sim.bodies.contacts import ContactCase
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

MEASURES = False

NEXT = {"link_pos": 5e-6, "link_quat": 2e-4, "link_vel": 3e-4, "link_ang": 2e-2}
"""Tolerances of the state after one outer step [m, 1, m/s, rad/s]."""

LEVEL = 0.1
"""Share of `NEXT` up to which a body is upright and neither turns nor moves sideways."""


def continued(trace: ContactTrace, case: ContactCase) -> dict[str, FloatArray]:
    """Return what follows from each state but the last in one outer step, by array."""
    begin = {name: getattr(trace, name)[:-1, 0].astype(np.float64) for name in NEXT}
    is_level = level(begin) if case.cone == "pyramidal" else np.zeros(trace.steps, bool)
    expected = up_and_down({name: of[is_level] for name, of in begin.items()}, case)
    if is_level.all():
        return expected
    further = by_mujoco({name: of[~is_level] for name, of in begin.items()}, case)
    both = {name: np.empty_like(of) for name, of in begin.items()}
    for name, of in both.items():
        of[is_level], of[~is_level] = expected[name], further[name]
    return both


def level(begin: Mapping[str, FloatArray]) -> np.ndarray:
    """Return (n,) whether a body is upright and neither turns nor moves sideways."""
    small = [
        np.abs(begin[name][:, of]).max(axis=1) < LEVEL * NEXT[name]
        for name, of in (("link_quat", slice(1, 4)), ("link_vel", slice(2)), ("link_ang", slice(3)))
    ]
    return np.asarray(np.all(small, axis=0))


def up_and_down(begin: Mapping[str, FloatArray], case: ContactCase) -> dict[str, FloatArray]:
    """Return the states after one outer step of a body that moves only along z.

    The contact points of an upright cube, or the one of a ball, have equal depths. The contact
    model gives each of their four edges of friction a force f ≥ 0 with a + R f = −B v − K d r at
    depth −r, where a = n f / m − g, d is the impedance, and R its regularization.
    """
    height, speed = begin["link_pos"][:, 2].copy(), begin["link_vel"][:, 2].copy()
    low, high, width, middle, _ = mujoco_contacts.IMPEDANCE
    default = mujoco_contacts.time_constant(case.h, case.time_constant)
    seconds, damping_ratio = case.spring or (default, 1.0)
    seconds = max(seconds, 2 * case.h)
    stiffness, damping = (high * seconds * damping_ratio) ** -2, 2 / (high * seconds)
    friction = max(case.friction, case.surface_friction) ** 2
    edges = 4 * (4 if case.shape == "cube" else 1)
    for _ in range(case.substeps):
        r = np.minimum(height - case.rest_height, 0)
        x = np.minimum(-r / width, 1)
        rise = np.where(x < middle, x**2 / middle, 1 - (1 - x) ** 2 / (1 - middle))
        d = low + rise * (high - low)
        regular = 2 * friction * (1 + friction) * (1 - d) / d
        wanted = case.gravity - damping * speed - stiffness * d * r
        force = np.where(r < 0, np.maximum(wanted, 0) * edges / (edges + regular), 0)
        speed += case.h * (force - case.gravity)
        height += case.h * speed
    after = {name: of.copy() for name, of in begin.items()}
    after["link_pos"][:, 2], after["link_vel"][:, 2] = height, speed
    return after


def by_mujoco(begin: Mapping[str, FloatArray], case: ContactCase) -> dict[str, FloatArray]:
    """Return what MuJoCo makes of states (n, …) in one outer step, by array."""
    import mujoco
    from mujoco import rollout

    model, quat = mujoco_contacts.load(case), begin["link_quat"]
    spin = rotate(quat * [1, -1, -1, -1], begin["link_ang"])  # in the body's axes
    at_zero = np.zeros((len(quat), 1))
    parts = (at_zero, begin["link_pos"], quat, begin["link_vel"], spin)
    data = mujoco.MjData(model)
    states, _ = rollout.rollout(model, [data], np.hstack(parts), nstep=case.substeps)
    last: Any = states[:, -1]
    _, position, orientation, velocity, spin = np.split(last, (1, 4, 8, 11), axis=1)
    return dict(
        zip(NEXT, (position, orientation, velocity, rotate(orientation, spin)), strict=True)
    )
