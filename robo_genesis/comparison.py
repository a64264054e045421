"""One metric of two cases: its order, the sentence about it, and a prediction held against it."""

from collections.abc import Mapping
from dataclasses import dataclass

from robo_genesis import measures
from robo_genesis.metrics import UNITS, StepMetrics, format_value

LABELS = measures.LABELS | {"saturation_samples": "number of saturated samples"}

HELD_BY = {
    "no later": ("lower", "equal"),
    "later": ("higher",),
    "higher": ("higher",),
    "lower": ("lower",),
}
"""The orders that hold a prediction."""

INSPECT = (
    "Before blaming the model, inspect saturation, the time stamps, the initial states and "
    "the length of the window."
)


@dataclass(frozen=True, slots=True)
class Comparison:
    """One metric of two cases. `order` is the second against the first, None if undecidable."""

    metric: str
    unit: str
    first: float | None
    second: float | None
    order: str | None  # "lower" | "equal" | "higher" | None


def compare(
    metric: str, first: StepMetrics, second: StepMetrics, resolution: Mapping
) -> Comparison:
    """Order one metric of two cases; a difference below the resolution of its unit is equal."""
    values = getattr(first, metric), getattr(second, metric)
    return compare_values(metric, UNITS[metric], *values, resolution)


def compare_values(
    metric: str, unit: str, a: float | None, b: float | None, resolution: Mapping
) -> Comparison:
    """Order a metric's values `a` and `b` of two cases, whatever the metric is."""
    return Comparison(metric, unit, a, b, order(a, b, resolution[unit]))


def order(a: float | None, b: float | None, resolution: float) -> str | None:
    """Order `b` against `a`: lower, equal or higher; None if neither was observed.

    A time that the window did not reach is later than any time within it.
    """
    if a is None or b is None:
        return None if a is b else "higher" if b is None else "lower"
    if abs(b - a) <= resolution:
        return "equal"
    return "higher" if b > a else "lower"


def comparison_sentence(names: tuple[str, str], comparison: Comparison) -> str:
    """Say how one metric of two cases compares."""
    label, unit = LABELS[comparison.metric], comparison.unit
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
    if comparison.order in HELD_BY[predicted]:
        return f"{claim}. Held in this run."
    return f"{claim}. **Did not hold**: measured {comparison.order}. {INSPECT}"
