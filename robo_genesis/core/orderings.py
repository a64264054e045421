"""Claimed orderings of two cases, and whether one run confirms them."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from robo_genesis.core.quantities import six_digits

HELD, WITHIN_MARGIN, BROKEN = "held", "within the margin", "broken"

Relation = tuple[tuple[str, str], str, str, float]
"""A claimed ordering: (first case, second case), metric, order, margin."""


class Value(NamedTuple):
    """One metric of one case; `value` is None if it was not observed."""

    value: float | None
    unit: str


HELD_BY = {
    "no later": ("lower", "equal"),
    "later": ("higher",),
    "higher": ("higher",),
    "lower": ("lower",),
}
"""The orders that confirm each claim."""


def order(a: float | None, b: float | None, resolution: float) -> str | None:
    """Return the order of `b` relative to `a`: lower, equal or higher; None if none was observed.

    A time that the window did not reach is later than any time within it.
    """
    if a is None or b is None:
        return None if a is b else "higher" if b is None else "lower"
    if abs(b - a) <= resolution:
        return "equal"
    return "higher" if b > a else "lower"


def outcome(numbers: Mapping[str, Any], relation: Relation) -> tuple[str, str]:
    """Return whether one run confirms an ordering, and the two values as text.

    `numbers` has metrics with `value` and `unit` by `case.name`. A difference within the margin
    confirms nothing, unless the claim is "no later" and the second value is not later at all.
    """
    (first, second), metric, claim, margin = relation
    a, b = (numbers.get(f"{case}.{metric}") for case in (first, second))
    if a is None or b is None:
        return WITHIN_MARGIN, f"{first} or {second} is missing"
    text = f"{first} {six_digits(a.value, a.unit)}, {second} {six_digits(b.value, b.unit)}"
    resolved, exact = (order(a.value, b.value, room) for room in (margin, 0))
    if claim == "no later" and exact in HELD_BY[claim]:
        return HELD, text
    if resolved in (None, "equal"):
        return WITHIN_MARGIN, text
    return (HELD if resolved in HELD_BY[claim] else BROKEN), text
