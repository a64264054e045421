"""A dropped box without the engine."""

from collections.abc import Callable

import numpy as np
import pytest

from robo_genesis.core.free_fall import summed_drop
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.rigid_bodies import Drop


@pytest.fixture(scope="session")
def make_drop() -> Callable[[Drop], BodyTrace]:
    """Build a dropped box that follows the stepped formula in float32."""

    def build(case: Drop) -> BodyTrace:
        t = np.arange(case.steps + 1) * case.dt
        position = np.zeros((len(t), 1, 3), np.float32)
        n = case.substeps * np.arange(len(t))
        position[:, 0, 2] = case.height - summed_drop(case.h, n, case.gravity)
        velocity = np.zeros_like(position)
        velocity[:, 0, 2] = -case.gravity * t
        upright = np.zeros((len(t), 1, 4), np.float32)
        upright[..., 0] = 1
        return BodyTrace(t, position, upright, velocity, np.zeros_like(position))

    return build
