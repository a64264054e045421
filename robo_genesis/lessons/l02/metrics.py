"""Metrics of a dropped box, computed from its trace, and their form in `metrics.json`."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.free_fall import continuous_gap, fallen, formula_error
from robo_genesis.sim.bodies.rigid_bodies import Drop


@dataclass(frozen=True, slots=True)
class DropMetrics(CaseMetrics):
    """Metrics of one dropped box; down is positive."""

    duration: float = metric("s", "duration", "t_s")
    drop: float = metric("m", "distance fallen", "link_pos_m")
    lowest: float = metric("m", "distance fallen at the lowest sample", "link_pos_m")
    final_speed: float = metric("m/s", "speed at the end", "link_vel_m_s")
    formula_error: float = metric(
        "m", "largest distance from the stepped formula", "link_pos_m", "t_s"
    )
    continuous_gap: float = metric(
        "m", "farther than continuous free fall", "link_pos_m", "t_s"
    )
    sideways: float = metric("m", "largest sideways motion", "link_pos_m")
    turning: float = metric("rad/s", "largest angular speed", "link_ang_rad_s")


def drop_metrics(trace: BodyTrace, case: Drop) -> DropMetrics:
    """Measure one drop; gravity and solver step of the case enter the formulas alone."""
    drop = fallen(trace)
    xy = trace.link_pos[:, 0, :2].astype(np.float64)
    return DropMetrics(
        duration=trace.t[-1],
        drop=drop[-1],
        lowest=drop.max(),
        final_speed=-trace.link_vel[-1, 0, 2],
        formula_error=formula_error(trace, case),
        continuous_gap=continuous_gap(trace, case),
        sideways=np.linalg.norm(xy - xy[0], axis=1).max(),
        turning=np.linalg.norm(trace.link_ang[:, 0].astype(np.float64), axis=1).max(),
    )
