"""Metrics of a dropped box, from its trace alone, and their form in `metrics.json`."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from robo_genesis import records
from robo_genesis.falling import continuous_drop, summed_drop
from robo_genesis.free_bodies import Drop
from robo_genesis.scene_config import FloatArray
from robo_genesis.trace import BodyTrace

UNITS = {
    "duration": "s",
    "drop": "m",
    "lowest": "m",
    "final_speed": "m/s",
    "formula_error": "m",
    "continuous_gap": "m",
    "sideways": "m",
    "turning": "rad/s",
}

SOURCES = {
    "duration": ("t_s",),
    "drop": ("link_pos_m",),
    "lowest": ("link_pos_m",),
    "final_speed": ("link_vel_m_s",),
    "formula_error": ("link_pos_m", "t_s"),
    "continuous_gap": ("link_pos_m", "t_s"),
    "sideways": ("link_pos_m",),
    "turning": ("link_ang_rad_s",),
}
"""The arrays that each metric is computed from, by their names in a bundle."""

LABELS = {
    "duration": "duration",
    "drop": "distance fallen",
    "lowest": "distance fallen at the lowest sample",
    "final_speed": "speed at the end",
    "formula_error": "largest distance from the stepped formula",
    "continuous_gap": "farther than continuous free fall",
    "sideways": "largest sideways motion",
    "turning": "largest angular speed",
}


@dataclass(frozen=True, slots=True)
class DropMetrics:
    """What one dropped box did; units in `UNITS`, down is positive."""

    duration: float
    drop: float
    lowest: float
    final_speed: float
    formula_error: float
    continuous_gap: float
    sideways: float
    turning: float

    def items(self) -> list[tuple[str, float, str]]:
        """Return (name, value, unit) in the order of the table."""
        return [(f.name, getattr(self, f.name), UNITS[f.name]) for f in fields(self)]


def fallen(trace: BodyTrace) -> FloatArray:
    """Return how far the first link is below its start at each sample, (n+1,) [m]."""
    height = trace.link_pos[:, 0, 2].astype(np.float64)
    return height[0] - height


def predicted(trace: BodyTrace, case: Drop) -> FloatArray:
    """Return what semi-implicit Euler drops by at each sample, (n+1,) [m]."""
    solver_steps = case.substeps * np.arange(len(trace.t))
    return summed_drop(case.h, solver_steps, case.gravity)


def drop_metrics(trace: BodyTrace, case: Drop) -> DropMetrics:
    """Measure one drop; the case gives gravity and solver step to the formulas alone."""
    below = fallen(trace)
    aside = trace.link_pos[:, 0, :2].astype(np.float64)
    return DropMetrics(
        duration=float(trace.t[-1]),
        drop=float(below[-1]),
        lowest=float(below.max()),
        final_speed=float(-trace.link_vel[-1, 0, 2]),
        formula_error=float(np.abs(below - predicted(trace, case)).max()),
        continuous_gap=float(below[-1] - continuous_drop(trace.t[-1:], case.gravity)[0]),
        sideways=float(np.linalg.norm(aside - aside[0], axis=1).max()),
        turning=float(np.linalg.norm(trace.link_ang[:, 0].astype(np.float64), axis=1).max()),
    )


def measure(traces: Mapping[str, BodyTrace], cases: Mapping[str, Drop]) -> dict[str, DropMetrics]:
    """Return the metrics of each case.

    Raises:
        KeyError: a case has no trace.
    """
    return {name: drop_metrics(traces[name], case) for name, case in cases.items()}


def metric_records(
    metrics: Mapping[str, DropMetrics], model: Mapping[str, int], mass: float
) -> dict[str, dict[str, dict[str, Any]]]:
    """Return `metrics.json`: the model's counts, the mass, and each case's metrics."""
    of_engine = {"model": records.counts(model), "body": records.readings({"mass": mass}, "kg")}
    return of_engine | records.cases(metrics, SOURCES)
