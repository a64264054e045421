"""Worked solutions of exercises, written from the arrays that the exercise asks for."""

from itertools import groupby

import numpy as np

from robo_genesis.core.quantities import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import SATURATION_THRESHOLD, StepMetrics

CANNOT = ("initial_error",)
"""Metrics of the first sample alone."""


def same_beginning(short: Trace, long: Trace) -> bool:
    """Return whether the longer run begins with the very samples of the shorter one."""
    n = short.steps
    return (
        long.steps > n
        and np.array_equal(short.q, long.q[: n + 1])
        and np.array_equal(short.qd, long.qd[:n])
        and np.array_equal(short.control_force, long.control_force[:n])
    )


def longer_window(short: tuple[Trace, StepMetrics], long: tuple[Trace, StepMetrics]) -> str:
    """Say which metrics of one case changed because its record is longer, as Markdown.

    Args:
        short: trace and metrics of the case.
        long: trace and metrics of the same case with more steps.
    """
    (a, of_a), (b, of_b) = short, long
    seconds = [format_value(float(trace.t[-1]), "s") for trace in (a, b)]
    if not same_beginning(a, b):
        return (
            f"The record of {seconds[1]} does not begin with the samples of the one of "
            f"{seconds[0]}, so this is another experiment, and no metric can be put down to the "
            "window. Look for what was not reset."
        )
    labels = of_a.about("label")
    rows = list(zip(of_a.items(), of_b.items(), strict=True))
    apart = [(name, unit, x, y) for (name, x, unit), (_, y, _) in rows if name not in CANNOT]
    moved = [row for row in apart if format_value(row[2], row[1]) != format_value(row[3], row[1])]
    kept = [labels[row[0]] for row in apart if row not in moved]
    lines = [
        f"- The first {seconds[0]} of both records are the same samples, bit by bit: the "
        "physics did not change.",
        *(
            f"- The {labels[name]} went from {format_value(x, unit)} to {format_value(y, unit)}. "
            f"{_why(name, x, y)}"
            for name, unit, x, y in moved
        ),
        f"- Unchanged, as far as written here: {'; '.join(kept)}."
        if kept
        else "- No metric stayed the same.",
        "- Could not change: the initial error, which is the first sample's"
        + (", and the rise time, which had been observed." if of_a.rise_time is not None else "."),
    ]
    return "\n".join(lines) + "\n"


def saturated_stretches(trace: Trace, entry: int) -> list[str]:
    """Say of each stretch of saturated samples of a joint what its force did to the motion.

    Force and velocity of one sign: it drives. Of two signs: it brakes.

    Args:
        trace: one run.
        entry: the joint's column.
    """
    force, speed = trace.control_force[:, entry], trace.qd[:, entry]
    clipped = np.abs(force) >= SATURATION_THRESHOLD * trace.effort_limit[entry]
    words = [
        f"{'positive' if f > 0 else 'negative'}, {'drives' if f * v > 0 else 'brakes'}"
        for f, v in zip(force, speed, strict=True)
    ]
    told = []
    for (hit, word), group in groupby(range(trace.steps), lambda n: (clipped[n], words[n])):
        samples = list(group)
        if hit:
            first, last = (
                format_value(float(trace.t_step[n]), "s") for n in (samples[0], samples[-1])
            )
            told.append(f"{first} to {last}: {word} the motion.")
    return told or ["No sample was at the limit."]


def _why(name: str, short: float | None, long: float | None) -> str:
    """Say how a longer record alone can move this metric."""
    if name in ("final_error", "final_velocity"):
        return "The last sample is another one."
    if short is None:
        return "It happened after the shorter record had ended."
    if name == "settling_time":
        return "The response left the band again, after the shorter record had ended."
    if long is not None:
        return "A larger value, or further samples, came later."
    return "No longer record can take back what was seen: inspect the definition."
