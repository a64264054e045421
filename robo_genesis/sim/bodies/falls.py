"""A body that falls freely: its distance, and how far it is from two formulas."""

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.free_fall import continuous_drop, summed_drop
from robo_genesis.sim.bodies.rigid_bodies import Drop


def fallen(trace: BodyTrace) -> FloatArray:
    """Return how far the first link is below its start at each sample, (n+1,) [m]."""
    height = trace.link_pos[:, 0, 2].astype(np.float64)
    return height[0] - height


def predicted(trace: BodyTrace, case: Drop) -> FloatArray:
    """Return the distance that semi-implicit Euler falls until each sample, (n+1,) [m]."""
    solver_steps = case.substeps * np.arange(len(trace.t))
    return summed_drop(case.h, solver_steps, case.gravity)


def formula_error(trace: BodyTrace, case: Drop) -> float:
    """Return the largest distance of a sample from the stepped formula [m]."""
    return float(np.abs(fallen(trace) - predicted(trace, case)).max())


def continuous_gap(trace: BodyTrace, case: Drop) -> float:
    """Return how much farther than g t² / 2 the body fell until the last sample [m]."""
    return float(fallen(trace)[-1] - continuous_drop(trace.t[-1:], case.gravity)[0])
