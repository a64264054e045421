"""Metrics of a box that lands, from its trace alone."""

from dataclasses import dataclass

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.rigid_bodies import Drop


@dataclass(frozen=True, slots=True)
class LandingMetrics(CaseMetrics):
    """What one box did; heights are those of its centre."""

    duration: float = metric("s", "duration", "t_s")
    drop: float = metric("m", "distance fallen", "link_pos_m")
    final_height: float = metric("m", "height at the end", "link_pos_m")
    final_speed: float = metric("m/s", "vertical speed at the end", "link_vel_m_s")


def landing_metrics(trace: BodyTrace, case: Drop) -> LandingMetrics:
    """Measure one landing."""
    start, end = float(trace.link_pos[0, 0, 2]), float(trace.link_pos[-1, 0, 2])
    speed = abs(float(trace.link_vel[-1, 0, 2]))
    return LandingMetrics(float(trace.t[-1]), start - end, end, speed)
