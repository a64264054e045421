"""A body that falls freely: its distance, how far it is from two formulas, and its start."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from robo_genesis.core.check_spec import START_TOLERANCE
from robo_genesis.core.checks import Finding, equal, within
from robo_genesis.core.free_fall import continuous_drop, summed_drop
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.rigid_bodies import Drop


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


def start(run: Any) -> Iterator[Finding]:
    """Check that each run begins at rest, at the height of its case; a named check."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        height = float(trace.link_pos[0, 0, 2])
        yield within(f"{name}.start_height_m", height, case.height, START_TOLERANCE)
        yield equal(f"{name}.start_velocity_m_s", np.abs(trace.link_vel[0]).max(), 0.0)
        yield equal(f"{name}.start_turning_rad_s", np.abs(trace.link_ang[0]).max(), 0.0)
