"""Sentences from measured metrics, right for every outcome, `not observed` included.

Nothing here is copied from an earlier run: each sentence is chosen and filled by the numbers that
it is given.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis.core.comparison import INSPECT, compare, comparison_sentence, prediction_sentence
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import Block
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import SATURATION_THRESHOLD, SETTLING_BAND, StepMetrics

SATURATION_SHARE = f"{100 * SATURATION_THRESHOLD:.0f} %"

AT_REST = 0.01
"""Speed below which the last sample is called nearly at rest [rad/s]."""


def pair_block(
    title: str,
    names: tuple[str, str],
    metrics: Mapping[str, StepMetrics],
    changed: list[str],
    predictions: tuple[tuple[str, str], ...],
    resolution: Mapping,
) -> Block:
    """Compare two cases that should differ in one entry.

    Args:
        title: heading of the block.
        names: the two cases, in order.
        metrics: by case name.
        changed: what the configurations really differ in, from `joint_control.differences`.
        predictions: (metric, order) written down before the runs.
        resolution: by unit, the difference that counts as none.
    """
    first, second = metrics[names[0]], metrics[names[1]]
    compared = {
        metric: compare(metric, first, second, resolution)
        for metric in ("rise_time", "peak_speed", "overshoot", "settling_time")
    }
    sentences = [factor_sentence(names, changed)]
    sentences += [comparison_sentence(names, c) for c in compared.values()]
    sentences += [
        prediction_sentence(names, compare(metric, first, second, resolution), order)
        for metric, order in predictions
    ]
    return Block(title, tuple(sentences))


def factor_sentence(names: tuple[str, str], changed: list[str]) -> str:
    """Say what two configurations differ in."""
    if len(changed) == 1:
        return (
            f"Between {names[0]} and {names[1]} only `{changed[0]}` differs; every other entry of "
            "the two configurations is equal, compared field by field."
        )
    found = ", ".join(f"`{entry}`" for entry in changed) or "nothing"
    return (
        f"{names[0]} and {names[1]} differ in {found}, so no difference below can be put down "
        "to one factor."
    )


def start_sentence(
    names: tuple[str, str],
    traces: Mapping[str, Trace],
    changed: Sequence[str],
    entry: int,
    resolution: Mapping,
) -> str:
    """Say what two cases did while both were clipped to the same effort, if they were.

    Under one and the same effort a difference in motion is no work of the controller. The engine's
    implicit integrator adds substep length · KV to the inertia of a position-controlled DOF: that
    explains it where KV alone was `changed`, and nowhere else.
    """
    one, other = (traces[name] for name in names)
    alike = _clipped_alike(one, other, entry)
    if alike == 0:
        return "No leading samples of the two were clipped to the same effort."
    speeds = [float(trace.qd[alike - 1, entry]) for trace in (one, other)]
    told = " and ".join(
        f"{name} {format_value(v, 'rad/s')}" for name, v in zip(names, speeds, strict=True)
    )
    time = format_value(float(one.t_step[alike - 1]), "s")
    lead = f"Up to {time} both were clipped to the same effort at each sample"
    if abs(speeds[0] - speeds[1]) <= resolution["rad/s"]:
        what = " and ".join(f"`{entry}`" for entry in changed) or "nothing"
        return f"{lead}, and they moved alike ({told}): there a change of {what} does not show."
    if not (len(changed) == 1 and changed[0].startswith("kv[")):
        return (
            f"{lead}, and yet they differ in speed there ({told}). The effort cannot be the "
            f"reason, and KV is not the one factor that changed. {INSPECT}"
        )
    return (
        f"{lead}, and yet they differ in speed there ({told}). The effort cannot be the reason: "
        "the engine's implicit integrator adds substep length × KV to the inertia of a position-"
        "controlled DOF, clipped or not. That part of the difference is numerical, and a smaller "
        "substep would shrink it."
    )


def _clipped_alike(one: Trace, other: Trace, entry: int) -> int:
    """Count the leading samples in which both traces have one and the same saturated effort."""
    a, b = one.control_force[:, entry], other.control_force[:, entry]
    alike = (a == b) & (np.abs(a) >= SATURATION_THRESHOLD * one.effort_limit[entry])
    return int(alike.argmin()) if not alike.all() else len(alike)


def cost_sentence(
    names: tuple[str, str], metrics: Mapping[str, StepMetrics], resolution: Mapping
) -> str:
    """Name what the second case pays in response time, or that it pays nothing here."""
    comparison = compare("rise_time", metrics[names[0]], metrics[names[1]], resolution)
    if comparison.order is None:
        return "What the change costs in response time cannot be told: no rise was observed."
    if comparison.second is None:
        return f"The cost in response time: {names[1]} did not reach 90 % in this window."
    if comparison.first is None:
        return f"No cost in response time here: {names[1]} reaches 90 %, {names[0]} does not."
    delay = comparison.second - comparison.first
    if comparison.order == "higher":
        return (
            f"The cost in response time: {names[1]} reaches 90 % {format_value(delay, 's')} later."
        )
    if comparison.order == "lower":
        return f"No cost in response time here: {names[1]} is {format_value(-delay, 's')} earlier."
    return "No cost in response time is visible at this sampling: both rise at the same sample."


def final_error_block(metrics: Mapping[str, StepMetrics]) -> Block:
    """Read each final error beside final velocity and settling, and say where that ends."""
    sentences = [final_error_sentence(name, m) for name, m in metrics.items()]
    sentences.append(
        "A small error that stays would be consistent with a controller without an integral term "
        "that holds the arm against gravity; the last sample of a finite window does not prove it."
    )
    return Block("3. What the final error says, and where that ends", tuple(sentences))


def final_error_sentence(name: str, m: StepMetrics) -> str:
    """Describe the end of one run."""
    at_rest = abs(m.final_velocity) <= AT_REST
    motion = f"nearly at rest (no more than {AT_REST:g} rad/s)" if at_rest else "still moving"
    ends = (
        f"{name} ends {format_value(m.final_error, 'rad')} from its target, {motion} at "
        f"{format_value(m.final_velocity, 'rad/s')}"
    )
    if m.settling_time is None and at_rest:
        return (
            f"{ends}; settling into ±{SETTLING_BAND:g} rad was not observed: it stands outside the "
            "band, and only a longer window would tell a steady error from a slow approach."
        )
    if m.settling_time is None:
        return (
            f"{ends}; settling into ±{SETTLING_BAND:g} rad was not observed, so its last sample "
            "is a moment of the transient, no steady error."
        )
    settled = format_value(m.settling_time, "s")
    tail = f"{ends}; it stays within ±{SETTLING_BAND:g} rad from {settled} on"
    if at_rest:
        return f"{tail}."
    return f"{tail}, yet its speed says that the error is not final."


def actuator_block(metrics: Mapping[str, StepMetrics], limit: float) -> Block:
    """Report the limits case by case; clipping, where found, ends ideal PD reasoning.

    Args:
        metrics: by case name.
        limit: effort limit read back from the engine [N·m].
    """
    sentences = []
    for name, m in metrics.items():
        peak = f"peak control {format_value(m.peak_control, 'N·m')} of {format_value(limit, 'N·m')}"
        if m.saturated:
            sentences.append(
                f"{name}: {format_value(m.saturation_samples, '1')} "
                f"({format_value(m.saturation_duration, 's')}) at or above "
                f"{SATURATION_SHARE} of the limit; {peak}. While the effort is clipped, a "
                "higher gain cannot add effort, and the ideal second-order picture does not apply."
            )
        else:
            sentences.append(
                f"{name}: no sample at or above {SATURATION_SHARE} of the limit; {peak}. "
                "At these stamps nothing was clipped."
            )
    return Block("4. What the actuator limit did", tuple(sentences))


def interpret(
    metrics: Mapping[str, StepMetrics],
    changed: Mapping[tuple[str, str], list[str]],
    predictions: Mapping[tuple[str, str], tuple[tuple[str, str], ...]],
    resolution: Mapping,
    traces: Mapping[str, Trace],
    entry: int,
) -> tuple[Block, ...]:
    """Return the four blocks for three cases compared pair by pair.

    Args:
        metrics: by case name, the three cases in order.
        changed: by pair, what their configurations differ in; two pairs in order (KP, KV).
        predictions: by pair, (metric, order) written down before the runs.
        resolution: by unit, the difference that counts as none.
        traces: by case name, what the metrics were computed from.
        entry: column of the stepped joint.
    """
    (kp_pair, kp_changed), (kv_pair, kv_changed) = changed.items()
    kp = pair_block(
        f"1. {kp_pair[0]} → {kp_pair[1]}: what KP did",
        kp_pair, metrics, kp_changed, predictions[kp_pair], resolution,
    )  # fmt: skip
    kp_start = start_sentence(kp_pair, traces, kp_changed, entry, resolution)
    kv = pair_block(
        f"2. {kv_pair[0]} → {kv_pair[1]}: what KV did, and its cost",
        kv_pair, metrics, kv_changed, predictions[kv_pair], resolution,
    )  # fmt: skip
    kv_start = start_sentence(kv_pair, traces, kv_changed, entry, resolution)
    cost = cost_sentence(kv_pair, metrics, resolution)
    limit = float(traces[kp_pair[0]].effort_limit[entry])
    return (
        Block(kp.title, (*kp.sentences, kp_start)),
        Block(kv.title, (*kv.sentences, cost, kv_start)),
        final_error_block(metrics),
        actuator_block(metrics, limit),
    )
