"""Step-response metrics of one joint, from a trace alone, and their form in `metrics.json`.

All of them look through a finite window at samples dt apart. They say what was seen there; none of
them is a proof of stability. What was not seen is None, written `not observed`.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from robo_genesis import records
from robo_genesis.trace import Trace

RISE_FRACTION = 0.9
"""Share of the step that counts as risen."""

SETTLING_BAND = 0.01
"""Half width of the settling band around the target [rad or m]."""

SATURATION_THRESHOLD = 0.99
"""Share of the read-back limit from which a sample is called saturated: a detector, no limit."""

UNITS = {
    "initial_error": "rad",
    "rise_time": "s",
    "overshoot": "rad",
    "settling_time": "s",
    "final_error": "rad",
    "final_velocity": "rad/s",
    "peak_speed": "rad/s",
    "peak_control": "N·m",
    "saturation_samples": "1",
    "saturation_duration": "s",
}
"""Unit of every metric for a revolute joint."""

SOURCES = {
    "initial_error": ("q_rad_or_m", "target_rad_or_m"),
    "rise_time": ("q_rad_or_m", "target_rad_or_m", "t_s"),
    "overshoot": ("q_rad_or_m", "target_rad_or_m"),
    "settling_time": ("q_rad_or_m", "target_rad_or_m", "t_s"),
    "final_error": ("q_rad_or_m", "target_rad_or_m"),
    "final_velocity": ("qd_rad_s_or_m_s",),
    "peak_speed": ("qd_rad_s_or_m_s",),
    "peak_control": ("control_force_Nm_or_N",),
    "saturation_samples": ("control_force_Nm_or_N", "effort_limit_Nm_or_N"),
    "saturation_duration": ("control_force_Nm_or_N", "effort_limit_Nm_or_N", "t_s"),
}
"""The arrays that each metric is computed from, by their names in a bundle."""

LABELS = {
    "initial_error": "initial error",
    "rise_time": "rise time",
    "overshoot": "overshoot",
    "settling_time": "settling time",
    "final_error": "final error",
    "final_velocity": "final velocity",
    "peak_speed": "peak speed",
    "peak_control": "peak control",
    "saturation_samples": "saturation",
    "saturation_duration": "saturation, seconds",
}

NOT_OBSERVED = "not observed"

DIGITS = {
    "s": 2, "rad": 4, "m": 4, "rad/s": 3, "m/s": 3, "N·m": 2, "N": 2, "kg": 3, "J": 4, "%": 1,
}  # fmt: skip
"""Digits after the point, by unit, where a value is written for a reader."""


@dataclass(frozen=True, slots=True)
class StepMetrics:
    """What one joint did in the window; units in `UNITS`, None where it was not observed."""

    initial_error: float
    rise_time: float | None
    overshoot: float
    settling_time: float | None
    final_error: float
    final_velocity: float
    peak_speed: float
    peak_control: float
    saturation_samples: int
    saturation_duration: float

    @property
    def saturated(self) -> bool:
        """Whether any sample reached the saturation threshold."""
        return self.saturation_samples > 0

    def items(self) -> list[tuple[str, float | None, str]]:
        """Return (name, value, unit) in the order of the table."""
        return [(f.name, getattr(self, f.name), UNITS[f.name]) for f in fields(self)]


def step_metrics(trace: Trace, entry: int) -> StepMetrics:
    """Measure the response of one revolute joint to a constant, higher target.

    rise       first sample with q − q₀ ≥ 0.9 (q_target − q₀)
    overshoot  max(0, max(q − q_target))
    settling   first sample from which |q − q_target| ≤ 0.01 holds to the end of the record
    saturation samples with |control force| ≥ 0.99 · read-back limit, stamped dt … n·dt

    Args:
        trace: the run; its target must not change on the way.
        entry: column of the joint in the trace's arrays.

    Raises:
        ValueError: the step is zero or negative (rise and overshoot are one-sided), the target
            changes during the run, or `entry` is no column.
    """
    if not 0 <= entry < trace.q.shape[1]:
        raise ValueError(f"entry {entry} given, the trace has joints 0 to {trace.q.shape[1] - 1}.")
    q = trace.q[:, entry].astype(np.float64)
    target = trace.target[:, entry].astype(np.float64)
    if not (target == target[0]).all():
        raise ValueError("The target changes during the run; these metrics take a constant one.")
    q_target = float(target[0])
    step = q_target - q[0]
    if step <= 0:
        raise ValueError(
            f"The step is {step:g} (from {q[0]:g} to {q_target:g}); rise and overshoot are "
            "defined for a positive step. Measure the mirrored response, or choose a higher target."
        )
    control = np.abs(trace.control_force[:, entry].astype(np.float64))
    threshold = SATURATION_THRESHOLD * float(trace.effort_limit[entry])
    saturation_samples = int((control >= threshold).sum())
    qd = trace.qd[:, entry].astype(np.float64)
    return StepMetrics(
        initial_error=float(step),
        rise_time=first_time(trace.t, q - q[0] >= RISE_FRACTION * step),
        overshoot=float(max(0.0, (q - q_target).max())),
        settling_time=settled_from(trace.t, np.abs(q - q_target) <= SETTLING_BAND),
        final_error=float(abs(q_target - q[-1])),
        final_velocity=float(qd[-1]),
        peak_speed=float(np.abs(qd).max()),
        peak_control=float(control.max()),
        saturation_samples=saturation_samples,
        saturation_duration=saturation_samples * trace.dt,
    )


def measure(
    traces: Mapping[str, Trace], cases: Iterable[str], entry: int
) -> dict[str, StepMetrics]:
    """Return the metrics of each of the cases, from its trace alone.

    Args:
        traces: the runs by case; others than the cases are left out.
        cases: whose metrics are wanted.
        entry: column of the joint in the traces' arrays.

    Raises:
        KeyError: a case has no trace.
        ValueError: as `step_metrics`.
    """
    return {case: step_metrics(traces[case], entry) for case in cases}


def metric_records(
    metrics: Mapping[str, StepMetrics], model: Mapping[str, int]
) -> dict[str, dict[str, dict[str, Any]]]:
    """Return `metrics.json`: the model's counts and each case's metrics, with class and source."""
    return {"model": records.counts(model)} | records.cases(metrics, SOURCES)


def first_time(t: np.ndarray, reached: np.ndarray) -> float | None:
    """Return the first t (n,) [s] at which `reached` (n,) is true, None where it never is."""
    return float(t[int(reached.argmax())]) if reached.any() else None


def settled_from(t: np.ndarray, inside: np.ndarray) -> float | None:
    """Return the t (n,) [s] from which `inside` (n,) holds to the end, None if it ends outside."""
    if not inside[-1]:
        return None
    outside = np.flatnonzero(~inside)
    return float(t[outside[-1] + 1]) if outside.size else float(t[0])


def format_value(value: float | None, unit: str) -> str:
    """Write a metric for a reader: `0.0447 rad`, `19 samples`, `not observed`."""
    if value is None:
        return NOT_OBSERVED
    if unit == "1":
        return f"{value} sample" if value == 1 else f"{value} samples"
    digits = DIGITS[unit]
    text = f"{value:.{digits}f}"
    return f"{text.removeprefix('-') if float(text) == 0 else text} {unit}"
