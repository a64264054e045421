"""The rows of a comparison of two bundles, and the states that they can have."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.comparison import (
    BROKEN,
    HELD,
    Relation,
    agree,
    allowed,
    differences,
    outcome,
)
from robo_genesis.core.text import quoted, six_digits
from robo_genesis.core.trace import TimeSeries

from .bundle import (
    Arrays,
    Manifest,
    Metric,
    by_full_name,
)

# States from best to worst. A row that is only shown does not affect the verdict.
EQUAL, SHOWN, WITHIN, INCONCLUSIVE, DIFFERS, NOT_COMPARABLE = SEVERITY = (
    "equal",
    "shown",
    "within tolerance",
    "inconclusive",
    "differs",
    "not comparable",
)

Tolerance = tuple[float, float]  # atol, rtol


@dataclass(frozen=True, slots=True)
class Side:
    """The content of one of the two bundles."""

    folder: str
    manifest: Manifest
    metrics: Mapping[str, Mapping[str, Metric]]
    arrays: Arrays
    traces: Mapping[str, TimeSeries]

    @property
    def numbers(self) -> dict[str, Metric]:
        """Every metric by `group.name`."""
        return by_full_name(self.metrics)

    @property
    def checks(self) -> dict[str, bool]:
        """Whether each check passed."""
        return {check.name: check.passed for check in self.manifest.checks}


@dataclass(frozen=True, slots=True)
class Row:
    """One row. `weight` orders rows of the same state: a difference as a share of its limit."""

    state: str
    what: str
    old: str
    new: str
    delta: str = ""
    allowed: str = ""
    weight: float = 0.0


@dataclass(frozen=True, slots=True)
class Section:
    """The rows of one kind, worst first."""

    title: str
    rows: tuple[Row, ...]

    @property
    def state(self) -> str:
        """State of the worst row, `equal` if there are no rows."""
        return worst([row.state for row in self.rows])


def worst(states: Sequence[str]) -> str:
    """Return the worst of some states, `equal` if there are none."""
    return max(states, key=SEVERITY.index, default=EQUAL)


def section(title: str, rows: Iterator[Row]) -> Section:
    """Return a section with its rows sorted, worst first."""
    found = sorted(rows, key=lambda row: (-SEVERITY.index(row.state), -row.weight))
    return Section(title, tuple(found))


def coverage(old: Side, new: Side) -> Iterator[Row]:
    """Both sides have the same cases, metrics, checks, labels and joints."""
    for what, here, there in differences(_content(old), _content(new), agree):
        yield Row(DIFFERS, what, quoted(here), quoted(there))


def _content(side: Side) -> dict[str, Any]:
    """Return each thing that a bundle has, with its description, by its kind."""
    units = {
        name: f"{metric.unit}, {metric.kind}" for name, metric in side.numbers.items()
    }
    return {
        "case": dict.fromkeys(side.traces, "present"),
        "check": dict.fromkeys(side.checks, "present"),
        "metric": units,
        "axis": side.arrays.coords,
        "joint": {joint.name: joint.model_dump() for joint in side.arrays.joints},
    }


def invariants(old: Side, new: Side) -> Iterator[Row]:
    """Every check passed on both sides, and the engine was the published one."""
    wheels = [side.manifest.engine.files_match_wheel for side in (old, new)]
    passed = {n: [old.checks[n], new.checks[n]] for n in old.checks if n in new.checks}
    for name, both in (passed | {"engine files match the wheel": wheels}).items():
        here, there = ("passed" if one else "FAILED" for one in both)
        yield Row(EQUAL if all(both) else DIFFERS, name, here, there)


def relations(old: Side, new: Side, claims: Sequence[Relation]) -> Iterator[Row]:
    """Both sides show each ordering that the lesson claims.

    Two runs that both break an ordering agree, but the claim of the lesson fails.
    """
    numbers = {**old.numbers, **new.numbers}
    for claimed in claims:
        (first, second), metric, claim, margin = claimed
        outcomes = [outcome(side.numbers, claimed) for side in (old, new)]
        words = {held for held, _ in outcomes}
        clear = EQUAL if words == {HELD} else INCONCLUSIVE
        state = DIFFERS if BROKEN in words else clear
        what = f"{metric}: {second} {claim} than {first}"
        here, there = (f"{held}: {text}" for held, text in outcomes)
        known = numbers.get(f"{first}.{metric}")
        limit = f"margin {six_digits(margin, known.unit if known else '1')}"
        yield Row(state, what, here, there, allowed=limit)


def values(
    old: Side, new: Side, tolerances: Mapping[str, Tolerance], kind: str
) -> Iterator[Row]:
    """The metrics of one class agree within atol + rtol · the larger magnitude.

    Counts have no tolerance. Performance is shown and does not affect the verdict.
    """
    for name, a in old.numbers.items():
        b = new.numbers.get(name)
        if b is None or not a.kind == b.kind == kind or a.unit != b.unit:
            continue
        text = six_digits(a.value, a.unit), six_digits(b.value, b.unit)
        if kind == "performance":
            yield Row(SHOWN, name, *text)
        elif a.value is None or b.value is None:
            yield Row(EQUAL if a.value == b.value else DIFFERS, name, *text)
        else:
            group, _, metric = name.partition(".")
            both = np.array([float(a.value)]), np.array([float(b.value)])
            yield _largest(name, (metric, group), *both, a.unit, tolerances)


def arrays(old: Side, new: Side, tolerances: Mapping[str, Tolerance]) -> Iterator[Row]:
    """Arrays have the same shape, and their values agree within atol + rtol · the larger magnitude.

    A tolerance is declared by the name of a case or an array or, except for counts, by
    a unit; without one, values must be equal. The row names the value that exceeds its
    tolerance most.
    """
    for case in [name for name in old.traces if name in new.traces]:
        for field, stored in old.traces[case].arrays().items():
            a, b = (
                getattr(side.traces[case], field, np.empty(0)) for side in (old, new)
            )
            what = f"{case} {stored.name}"
            if a.shape != b.shape or a.dtype != b.dtype:
                here, there = (f"{one.dtype}, shape {one.shape}" for one in (a, b))
                yield Row(DIFFERS, what, here, there)
            elif np.array_equal(a, b):
                yield Row(EQUAL, what, str(a.shape), str(b.shape))
            else:
                unit = old.arrays.cases[case].variables[stored.name].unit
                yield _largest(what, (case, stored.name), a, b, unit, tolerances)


def _largest(
    what: str,
    names: tuple[str, ...],
    a: np.ndarray,
    b: np.ndarray,
    unit: str | list[str],
    tolerances: Mapping[str, Tolerance],
) -> Row:
    """Return the row of two arrays: of the value that exceeds its tolerance most.

    Args:
        what: the text of the row; the place in an array is added.
        names: of the metric and its group, or of the case and the array. The first with
            a tolerance of its own decides, else the unit.
        a: those of the old side.
        b: those of the new side, of the same shape.
        unit: a list if the last axis has DOFs.
        tolerances: by name or unit.
    """
    units = [unit] if isinstance(unit, str) else unit
    own = next((tolerances[name] for name in names if name in tolerances), None)
    by_unit = {} if np.issubdtype(a.dtype, np.integer) else tolerances
    limits = [own or by_unit.get(name, (0.0, 0.0)) for name in units]
    here, there = a.astype(np.float64), b.astype(np.float64)
    room = allowed(here, there, *np.transpose(limits))
    apart = np.abs(there - here)
    without = np.where(apart == 0, 0.0, np.inf)  # a share of no tolerance
    shares = np.divide(apart, room, out=without, where=room > 0)
    last = np.lexsort((apart.ravel(), shares.ravel()))[-1]
    at = np.unravel_index(last, a.shape)
    state = DIFFERS if shares[at] > 1 else WITHIN if apart[at] else EQUAL
    place = f"[{', '.join(map(str, at))}]" if a.size > 1 else ""
    own_unit = units[int(at[-1]) % len(units)]
    was, now, delta, limit = (
        six_digits(float(array[at]), own_unit)
        for array in (here, there, there - here, room)
    )
    return Row(state, f"{what}{place}", was, now, delta, limit, float(shares[at]))
