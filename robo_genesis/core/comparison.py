"""One metric of two cases: its order, a sentence about it, and the outcome of a prediction."""

from collections.abc import Mapping
from dataclasses import dataclass

from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.orderings import HELD_BY, order
from robo_genesis.core.quantities import format_value

MEASURES = False


@dataclass(frozen=True, slots=True)
class Comparison:
    """One metric of two cases. `order` is that of the second relative to the first.

    It is lower, equal or higher, and None if the values cannot be ranked. It is equal where the
    values differ by no more than the declared `margin`.
    """

    label: str
    unit: str
    first: float | None
    second: float | None
    order: str | None
    margin: float = 0.0


def compare(
    metric: str,
    first: CaseMetrics,
    second: CaseMetrics,
    resolution: Mapping[str, float],
    margin: float = 0.0,
) -> Comparison:
    """Order one metric of two cases; a difference below the resolution of its unit is equal."""
    noun, unit = (first.about(what)[metric] for what in ("noun", "unit"))
    values = getattr(first, metric), getattr(second, metric)
    return compare_values(noun, unit, *values, resolution, margin)


def compare_values(
    label: str,
    unit: str,
    a: float | None,
    b: float | None,
    resolution: Mapping[str, float],
    margin: float = 0.0,
) -> Comparison:
    """Order the values `a` and `b` of one metric in two cases; `label` is its name in prose.

    A difference up to the margin is equal, as is one up to the resolution of the unit.
    """
    found = order(a, b, max(resolution[unit], margin))
    return Comparison(label, unit, a, b, found, margin)


def comparison_sentence(names: tuple[str, str], comparison: Comparison) -> str:
    """Return a sentence that compares one metric of two cases."""
    label, unit = comparison.label, comparison.unit
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
    if comparison.order == "equal" and comparison.margin and first != second:
        margin = f"{comparison.margin:g} {'samples' if unit == '1' else unit}"
        return f"The {label} is too close to call: {values}, within the margin of {margin}."
    verb = {"lower": "goes down", "higher": "goes up", "equal": "does not change measurably"}
    return f"The {label} {verb[comparison.order]} ({values})."


def prediction_sentence(
    names: tuple[str, str], comparison: Comparison, predicted: str, advice: str
) -> str:
    """Return the outcome of a prediction; `advice` follows one that did not hold."""
    label = comparison.label
    claim = f"Predicted: {label} {predicted} in {names[1]} than in {names[0]}"
    if comparison.order is None:
        return f"{claim}. Cannot be judged: not observed in either case."
    if comparison.order in HELD_BY[predicted]:
        return f"{claim}. Held in this run."
    return f"{claim}. **Did not hold**: measured {comparison.order}. {advice}"
