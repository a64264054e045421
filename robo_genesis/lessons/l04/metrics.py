"""Step-response metrics of one joint, from a trace alone, and their form in `metrics.json`.

All of them describe a finite window with samples dt apart; none of them proves
stability. A metric that was not observed is None.
"""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace, first_time, settled_from

RISE_FRACTION = 0.9  # Share of the step that counts as risen

SETTLING_BAND = 0.01  # Half width of the settling band around the target [rad or m]

# Share of the read-back limit from which a sample is called saturated. It detects
# saturation; the engine clips at the full limit.
SATURATION_THRESHOLD = 0.99


def is_saturated(
    control_force: FloatArray | float, limit: FloatArray | float
) -> np.ndarray:
    """Return where a control force of either sign reaches the saturation threshold of its limit."""
    return np.abs(control_force) >= SATURATION_THRESHOLD * limit


# Arrays of a bundle that several metrics are computed from.
RESPONSE = ("q_rad_or_m", "target_rad_or_m")
EFFORT = ("control_force_Nm_or_N", "effort_limit_Nm_or_N")


@dataclass(frozen=True, slots=True)
class StepMetrics(CaseMetrics):
    """Step response of one joint in the window; None where a metric was not observed."""

    initial_error: float = metric("rad", "initial error", *RESPONSE)
    rise_time: float | None = metric("s", "rise time", *RESPONSE, "t_s")
    overshoot: float = metric("rad", "overshoot", *RESPONSE)
    settling_time: float | None = metric("s", "settling time", *RESPONSE, "t_s")
    final_error: float = metric("rad", "final error", *RESPONSE)
    final_velocity: float = metric("rad/s", "final velocity", "qd_rad_s_or_m_s")
    peak_speed: float = metric("rad/s", "peak speed", "qd_rad_s_or_m_s")
    peak_control: float = metric("N·m", "peak control", "control_force_Nm_or_N")
    saturation_samples: int = metric(
        "1", "saturation", *EFFORT, noun="number of saturated samples"
    )
    saturation_duration: float = metric("s", "saturation, seconds", *EFFORT, "t_s")


def step_metrics(trace: Trace, entry: int) -> StepMetrics:
    """Measure the response of one revolute joint to a constant, higher target.

    rise       first sample with q − q₀ ≥ 0.9 (q_target − q₀)
    overshoot  max(0, max(q − q_target))
    settling   first sample from which |q − q_target| ≤ 0.01 holds to the end of the record
    saturation samples with |control force| ≥ 0.99 · read-back limit, at times dt … n·dt

    Args:
        trace: the run; its target must be constant.
        entry: column of the joint in the trace's arrays.

    Raises:
        ValueError: the step is zero or negative; rise and overshoot are one-sided.
    """
    q = trace.q[:, entry].astype(np.float64)
    q_target = float(trace.target[0, entry])
    step = q_target - q[0]
    if step <= 0:
        raise ValueError(
            f"The step is {step:g} (from {q[0]:g} to {q_target:g}); rise and overshoot are "
            "defined for a positive step. Measure the mirrored response, or choose a higher target."
        )
    control = np.abs(trace.control_force[:, entry].astype(np.float64))
    saturation_samples = int(
        is_saturated(control, float(trace.effort_limit[entry])).sum()
    )
    qd = trace.qd[:, entry].astype(np.float64)
    return StepMetrics(
        initial_error=step,
        rise_time=first_time(trace.t, q - q[0] >= RISE_FRACTION * step),
        overshoot=max(0.0, (q - q_target).max()),
        settling_time=settled_from(trace.t, np.abs(q - q_target) <= SETTLING_BAND),
        final_error=abs(q_target - q[-1]),
        final_velocity=qd[-1],
        peak_speed=np.abs(qd).max(),
        peak_control=control.max(),
        saturation_samples=saturation_samples,
        saturation_duration=saturation_samples * trace.dt,
    )
