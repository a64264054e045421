"""Metrics of a sphere that falls, from its trace alone."""

from dataclasses import dataclass

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.free_fall import continuous_gap, fallen, formula_error
from robo_genesis.sim.bodies.rigid_bodies import Drop

from .spec import ASKED_STEPS


@dataclass(frozen=True, slots=True)
class FallMetrics(CaseMetrics):
    """What one sphere did; heights are those of its centre."""

    duration: float = metric("s", "duration", "t_s")
    final_height: float = metric("m", "height at the end", "link_pos_m")
    asked_height: float = metric(
        "m", f"height after {ASKED_STEPS} outer steps", "link_pos_m"
    )
    drop: float = metric("m", "distance fallen", "link_pos_m")
    formula_error: float = metric(
        "m", "largest distance from the computed height", "link_pos_m", "t_s"
    )
    school_gap: float = metric(
        "m", "additional fall beyond g t² / 2", "link_pos_m", "t_s"
    )


def fall_metrics(trace: BodyTrace, case: Drop) -> FallMetrics:
    """Measure one fall; gravity and solver step of the case enter the formulas alone."""
    return FallMetrics(
        duration=trace.t[-1],
        final_height=trace.link_pos[-1, 0, 2],
        asked_height=trace.link_pos[ASKED_STEPS, 0, 2],
        drop=fallen(trace)[-1],
        formula_error=formula_error(trace, case),
        school_gap=continuous_gap(trace, case),
    )
