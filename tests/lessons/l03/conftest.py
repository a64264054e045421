"""Synthetic runs of L03, made without the engine."""

from collections.abc import Callable

import numpy as np
import pytest

from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import spec
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import ContactCase


@pytest.fixture(scope="session")
def slide_on_corners() -> Callable[[ContactCase], ContactTrace]:
    """Build a cube that slides on four corners as semi-implicit Euler has Coulomb's friction."""

    def build(case: ContactCase) -> ContactTrace:
        states, friction = case.steps + 1, max(case.friction, case.surface_friction)
        speed = case.speed - friction * case.gravity * case.h * np.arange(states * case.substeps)
        speed = np.maximum(speed, 0)
        x = np.concatenate([[0], np.cumsum(case.h * speed[1:])])[:: case.substeps]
        position, velocity = (np.zeros((states, 1, 3), np.float32) for _ in range(2))
        position[:, 0] = case.start
        position[:, 0, 0] += x
        velocity[:, 0, 0] = speed[:: case.substeps]
        upright = np.zeros((states, 1, 4), np.float32)
        upright[..., 0] = 1
        t, corners = np.arange(states) * case.dt, np.full((states, 1), 4, np.int32)
        still, depth = np.zeros_like(position), np.zeros((states, 1), np.float32)
        return ContactTrace(t, position, upright, velocity, still, corners, depth)

    return build


@pytest.fixture(scope="session")
def contact_traces(slide_on_corners) -> dict[str, ContactTrace]:
    """The runs of lab and lecture, with MuJoCo in the place of both engines."""
    traces = {
        name: mujoco_contacts.run_case(case, own_defaults=name == spec.OWN_DEFAULTS)
        for name, case in (spec.CASES | spec.STUDY_CASES).items()
    }
    return traces | {name: slide_on_corners(case) for name, case in spec.CLEAN_SLIDES.items()}
