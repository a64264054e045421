"""Runs of one free body without Genesis: given by positions, dropped, sliding by Coulomb's law."""

import numpy as np

from robo_genesis.core.trace import BodyTrace, ContactTrace
from robo_genesis.sim.bodies.contacts import ContactCase
from robo_genesis.sim.bodies.free_fall import summed_drop
from robo_genesis.sim.bodies.rigid_bodies import Drop


def body_run(
    t, x=0.0, y=0.0, z=0.0, *, vx=0.0, vz=0.0, quat=(1, 0, 0, 0), contacts=None
):
    """Return a run from values for each state, or for all; with a count of contacts if given."""
    position, velocity, orientation, still = (
        np.float32(np.stack(np.broadcast_arrays(*parts, t)[:-1], axis=-1))[:, None]
        for parts in ((x, y, z), (vx, 0, vz), quat, (0, 0, 0))
    )
    motion = (t, position, orientation, velocity, still)
    if contacts is None:
        return BodyTrace(*motion)
    counts = np.broadcast_to(np.int32(contacts), len(t))[:, None]
    return ContactTrace(*motion, counts, np.zeros((len(t), 1), np.float32))


def body_at(z, *, dt=0.01, contacts=0, **given) -> ContactTrace:
    """Return a run with contacts of a body at x = y = 0, from its heights."""
    return body_run(np.arange(len(z)) * dt, z=z, contacts=contacts, **given)


def make_drop(case: Drop) -> BodyTrace:
    """Return a drop that follows the stepped formula in float32."""
    n = np.arange(case.steps + 1)
    height = case.height - summed_drop(case.h, case.substeps * n, case.gravity)
    return body_run(n * case.dt, z=height, vz=-case.gravity * (n * case.dt))


def slide_on_corners(case: ContactCase) -> ContactTrace:
    """Return a cube that slides on four corners: Coulomb friction by semi-implicit Euler."""
    states, friction = case.steps + 1, max(case.friction, case.surface_friction)
    speed = case.speed - friction * case.gravity * case.h * np.arange(
        states * case.substeps
    )
    speed = np.maximum(speed, 0)
    travelled = np.concatenate([[0], np.cumsum(case.h * speed[1:])])[:: case.substeps]
    x, y, z = np.float32(case.start)
    return body_run(
        np.arange(states) * case.dt,
        x + travelled,
        y,
        z,
        vx=speed[:: case.substeps],
        contacts=4,
    )
