"""Sentences from measured metrics, right for every outcome, `not observed` included.

Nothing here is copied from an earlier run: each sentence is chosen and filled by the numbers that
it is given.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from robo_genesis.metrics import (
    SATURATION_THRESHOLD,
    SETTLING_BAND,
    UNITS,
    StepMetrics,
    format_value,
)

LABELS = {
    "rise_time": "rise time",
    "peak_speed": "peak speed",
    "overshoot": "overshoot",
    "settling_time": "settling time",
    "saturation_samples": "number of saturated samples",
    "final_error": "final error",
}
AT_REST = 0.01
"""Speed below which the last sample is called nearly at rest [rad/s]."""

INSPECT = (
    "Before blaming the model, inspect saturation, the time stamps, the initial states and "
    "the length of the window."
)


@dataclass(frozen=True, slots=True)
class Block:
    """One block of the interpretation: a title and its sentences, in order."""

    title: str
    sentences: tuple[str, ...]

    def markdown(self) -> str:
        """Return the block as a Markdown list under a bold title."""
        return "\n".join([f"**{self.title}**", "", *(f"- {s}" for s in self.sentences), ""])


@dataclass(frozen=True, slots=True)
class Comparison:
    """One metric of two cases. `order` is the second against the first, None if undecidable."""

    metric: str
    first: float | None
    second: float | None
    order: str | None  # "lower" | "equal" | "higher" | None


def compare(
    metric: str, first: StepMetrics, second: StepMetrics, resolution: Mapping
) -> Comparison:
    """Order one metric of two cases; a difference below the resolution of its unit is equal."""
    a, b = getattr(first, metric), getattr(second, metric)
    if a is None and b is None:
        order = None
    elif a is None or b is None:
        # A time that the window did not reach is later than any time within it.
        order = "higher" if b is None else "lower"
    elif abs(b - a) <= resolution[UNITS[metric]]:
        order = "equal"
    else:
        order = "higher" if b > a else "lower"
    return Comparison(metric, a, b, order)


def comparison_sentence(names: tuple[str, str], comparison: Comparison) -> str:
    """Say how one metric of two cases compares."""
    label, unit = LABELS[comparison.metric], UNITS[comparison.metric]
    first, second = (format_value(v, unit) for v in (comparison.first, comparison.second))
    values = f"{names[0]} {first}, {names[1]} {second}"
    if comparison.order is None:
        return f"The {label} was not observed in either case, so this window cannot rank them."
    if None in (comparison.first, comparison.second):
        seen, unseen = names if comparison.second is None else names[::-1]
        return (
            f"The {label} was observed for {seen} alone ({values}); within this window "
            f"{unseen} is the slower one, by how much is unknown."
        )
    verb = {"lower": "goes down", "higher": "goes up", "equal": "does not change measurably"}
    return f"The {label} {verb[comparison.order]} ({values})."


def prediction_sentence(names: tuple[str, str], comparison: Comparison, predicted: str) -> str:
    """Hold one prediction against the measured order; one that fails says what to inspect."""
    label = LABELS[comparison.metric]
    claim = f"Predicted: {label} {predicted} in {names[1]} than in {names[0]}"
    if comparison.order is None:
        return f"{claim}. Cannot be judged: not observed in either case."
    held = (
        comparison.order
        in {
            "no later": ("lower", "equal"),
            "later": ("higher",),
            "higher": ("higher",),
            "lower": ("lower",),
        }[predicted]
    )
    if held:
        return f"{claim}. Held in this run."
    return f"{claim}. **Did not hold**: measured {comparison.order}. {INSPECT}"


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
    motion = "nearly at rest" if at_rest else "still moving"
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
        return f"{tail}, so the tail is quiet as far as this window shows."
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
                f"{SATURATION_THRESHOLD:.0%} of the limit; {peak}. While the effort is clipped, a "
                "higher gain cannot add effort, and the ideal second-order picture does not apply."
            )
        else:
            sentences.append(
                f"{name}: no sample at or above {SATURATION_THRESHOLD:.0%} of the limit; {peak}. "
                "At these stamps nothing was clipped."
            )
    return Block("4. What the actuator limit did", tuple(sentences))


def interpret(
    metrics: Mapping[str, StepMetrics],
    changed: Mapping[tuple[str, str], list[str]],
    predictions: Mapping[tuple[str, str], tuple[tuple[str, str], ...]],
    resolution: Mapping,
    limit: float,
) -> tuple[Block, ...]:
    """Return the four blocks for three cases compared pair by pair.

    Args:
        metrics: by case name, the three cases in order.
        changed: by pair, what their configurations differ in; two pairs in order (KP, KV).
        predictions: by pair, (metric, order) written down before the runs.
        resolution: by unit, the difference that counts as none.
        limit: effort limit of the stepped joint, read back [N·m].
    """
    (kp_pair, kp_changed), (kv_pair, kv_changed) = changed.items()
    kp = pair_block(
        f"1. {kp_pair[0]} → {kp_pair[1]}: what KP did",
        kp_pair, metrics, kp_changed, predictions[kp_pair], resolution,
    )  # fmt: skip
    kv = pair_block(
        f"2. {kv_pair[0]} → {kv_pair[1]}: what KV did, and its cost",
        kv_pair, metrics, kv_changed, predictions[kv_pair], resolution,
    )  # fmt: skip
    kv = Block(kv.title, (*kv.sentences, cost_sentence(kv_pair, metrics, resolution)))
    return kp, kv, final_error_block(metrics), actuator_block(metrics, limit)
