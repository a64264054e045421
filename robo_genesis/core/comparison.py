"""How values are compared: orders of two cases, tolerances, and differences of nested values."""

import math
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .text import six_digits

HELD, WITHIN_MARGIN, BROKEN = "held", "within the margin", "broken"

# Relative tolerance of a recorded value against the one that is computed again
SAME_FLOAT = 1e-9

ROUNDING = 1e-12  # Tolerance of such a value near zero, in its own unit

# A claimed ordering: (first case, second case), metric, order, margin.
Relation = tuple[tuple[str, str], str, str, float]


class Value(NamedTuple):
    """One metric of one case; `value` is None if it was not observed."""

    value: float | None
    unit: str


# The orders that confirm each claim.
HELD_BY = {
    "no later": ("lower", "equal"),
    "later": ("higher",),
    "higher": ("higher",),
    "lower": ("lower",),
    "equal": ("equal",),
}


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

    `numbers` has metrics with `value` and `unit` by `case.name`. A difference within
    the margin confirms nothing, unless the claim is "equal", or is "no later" and the
    second value is not later at all.
    """
    (first, second), metric, claim, margin = relation
    a, b = (numbers.get(f"{case}.{metric}") for case in (first, second))
    if a is None or b is None:
        return WITHIN_MARGIN, f"{first} or {second} is missing"
    text = (
        f"{first} {six_digits(a.value, a.unit)}, {second} {six_digits(b.value, b.unit)}"
    )
    resolved, exact = (order(a.value, b.value, room) for room in (margin, 0))
    if claim == "no later" and exact in HELD_BY[claim]:
        return HELD, text
    if resolved in (None, "equal") and resolved != claim:
        return WITHIN_MARGIN, text
    return (HELD if resolved in HELD_BY[claim] else BROKEN), text


@dataclass(frozen=True, slots=True)
class Comparison:
    """One metric of two cases; `label` is its name in prose.

    Values are equal if they differ by no more than the `resolution` of the unit or the
    declared `margin`.
    """

    label: str
    unit: str
    first: float | None
    second: float | None
    resolution: float
    margin: float = 0.0

    @property
    def order(self) -> str | None:
        """The order of the second value relative to the first, as of the function `order`."""
        return order(self.first, self.second, max(self.resolution, self.margin))


def allowed(a: Any, b: Any, atol: Any, rtol: Any) -> Any:
    """Return atol + rtol · the larger magnitude, the allowed difference of numbers or arrays."""
    return atol + rtol * np.maximum(np.abs(a), np.abs(b))


def agree(recorded: Any, computed: Any) -> bool:
    """Return whether two values are equal; floats may differ by rounding on another CPU."""
    if isinstance(recorded, float) and isinstance(computed, float):
        return math.isclose(recorded, computed, rel_tol=SAME_FLOAT, abs_tol=ROUNDING)
    return type(recorded) is type(computed) and bool(recorded == computed)


def differences(
    found: Any,
    expected: Any,
    same: Callable[[Any, Any], bool] = operator.eq,
    path: str = "",
) -> Iterator[tuple[str, Any, Any]]:
    """Yield (path, found, expected) where two JSON values differ; `absent` is a missing entry.

    Args:
        found: of objects, each entry is compared; everything else as a whole.
        expected: likewise.
        same: compares two values that are not both objects.
        path: of the two values in a larger one.
    """
    if isinstance(found, dict) and isinstance(expected, dict):
        for name in sorted(found.keys() | expected.keys()):
            inner = f"{path}.{name}" if path else name
            here, there = found.get(name, "absent"), expected.get(name, "absent")
            yield from differences(here, there, same, inner)
    elif not same(found, expected):
        yield path, found, expected
