"""The rows of a comparison of two bundles, and the states that they can have."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.comparison import (
    BROKEN,
    HELD,
    WITHIN_MARGIN,
    Relation,
    allowed,
    outcome,
)
from robo_genesis.core.text import six_digits
from robo_genesis.core.trace import TimeSeries
from robo_genesis.evidence.bundle import (
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

MISSING = "missing"

# State and verdict of a claimed ordering by its outcomes in the two runs.
#
# Two runs that both break an ordering agree, but the claim of the lesson fails.
VERDICTS = {
    frozenset({HELD}): (EQUAL, "held in both"),
    frozenset({WITHIN_MARGIN}): (INCONCLUSIVE, "inconclusive"),
    frozenset({HELD, WITHIN_MARGIN}): (INCONCLUSIVE, "inconclusive"),
    frozenset({BROKEN}): (DIFFERS, "broken in both"),
    frozenset({HELD, BROKEN}): (DIFFERS, "flipped"),
    frozenset({BROKEN, WITHIN_MARGIN}): (
        DIFFERS,
        "broken in one, undecided in the other",
    ),
}


@dataclass(frozen=True, slots=True)
class PageSpecification:
    """What a lesson declares about the runs of one of its pages.

    `metrics` gives the required metrics of each case; `tolerances` is unit, metric,
    group of metrics, case or array → (atol, rtol).
    """

    metrics: Mapping[str, tuple[str, ...]]
    tolerances: Mapping[str, tuple[float, float]]
    relations: tuple[Relation, ...]


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
    """The rows of one kind, worst first; `empty` is the text of a section without rows."""

    title: str
    rows: tuple[Row, ...]
    empty: str = ""

    @property
    def state(self) -> str:
        """State of the worst row, `equal` if there are no rows."""
        return worst([row.state for row in self.rows])


def worst(states: Sequence[str]) -> str:
    """Return the worst of some states, `equal` if there are none."""
    return max(states, key=SEVERITY.index, default=EQUAL)


def section(title: str, rows: Iterator[Row], empty: str = "") -> Section:
    """Return a section with its rows sorted, worst first."""
    found = sorted(rows, key=lambda row: (-SEVERITY.index(row.state), -row.weight))
    return Section(title, tuple(found), empty)


def coverage(old: Side, new: Side, spec: PageSpecification) -> Iterator[Row]:
    """Both sides have the same cases, metrics, checks, labels and joints."""
    here, there = _content(old), _content(new)
    declared = {f"case {case}" for case in spec.metrics}
    declared |= {
        f"metric {case}.{name}"
        for case, names in spec.metrics.items()
        for name in names
    }
    for name in sorted({*here, *there, *declared}):
        both = here.get(name, MISSING), there.get(name, MISSING)
        if both[0] != both[1] or MISSING in both:
            yield Row(DIFFERS, name, *both)


def _content(side: Side) -> dict[str, str]:
    """Return each thing that a bundle has, with its description; names begin with the kind."""
    content = {f"case {name}": "present" for name in side.traces}
    content |= {f"check {name}": "present" for name in side.checks}
    for name, metric in side.numbers.items():
        content[f"metric {name}"] = f"{metric.unit}, {metric.kind}"
    for name, labels in side.arrays.coords.items():
        content[f"axis {name}"] = ", ".join(labels)
    for joint in side.arrays.joints:
        limits = (six_digits(limit, joint.unit) for limit in (joint.lower, joint.upper))
        places = f"DOF {joint.dof_idx_local}, qpos {joint.q_idx_local}"
        content[f"joint {joint.name}"] = (
            f"{joint.type_}, {places}, {' to '.join(limits)}"
        )
    return content


def invariants(old: Side, new: Side) -> Iterator[Row]:
    """Every check passed on both sides, and the engine was the published one."""
    wheels = [side.manifest.engine.files_match_wheel for side in (old, new)]
    passed = {n: [old.checks[n], new.checks[n]] for n in old.checks if n in new.checks}
    for name, both in (passed | {"engine files match the wheel": wheels}).items():
        here, there = ("passed" if one else "FAILED" for one in both)
        yield Row(EQUAL if all(both) else DIFFERS, name, here, there)


def relations(old: Side, new: Side, spec: PageSpecification) -> Iterator[Row]:
    """Both sides show each ordering that the lesson claims."""
    for relation in spec.relations:
        (first, second), metric, claim, margin = relation
        outcomes = [outcome(side.numbers, relation) for side in (old, new)]
        state, verdict = VERDICTS[frozenset(held for held, _ in outcomes)]
        units = [
            m.unit
            for side in (old, new)
            if (m := side.numbers.get(f"{first}.{metric}"))
        ]
        what = f"{metric}: {second} {claim} than {first}, {verdict}"
        here, there = (f"{held}: {text}" for held, text in outcomes)
        limit = f"margin {six_digits(margin, units[0] if units else '1')}"
        yield Row(state, what, here, there, allowed=limit)


def values(old: Side, new: Side, spec: PageSpecification, kind: str) -> Iterator[Row]:
    """The metrics of one class agree within atol + rtol · the larger magnitude.

    Counts have no tolerance. Performance is shown and does not affect the verdict.
    """
    limits = spec.tolerances if kind == "value" else {}
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
            here, there = (np.array(float(value)) for value in (a.value, b.value))
            group, _, metric = name.partition(".")
            yield _largest(name, (metric, group), here, there, a.unit, limits)


def arrays(old: Side, new: Side, spec: PageSpecification) -> Iterator[Row]:
    """Arrays have the same shape, and their values agree within atol + rtol · the larger magnitude.

    A tolerance is declared by the name of a case or an array or, except for counts, by
    a unit; without one, values must be equal. The row names the value that exceeds its
    tolerance most.
    """
    for case in [name for name in old.traces if name in new.traces]:
        for field, (name, *_) in old.traces[case].arrays().items():
            a, b = (
                getattr(side.traces[case], field, np.empty(0)) for side in (old, new)
            )
            what, unit = f"{case} {name}", old.arrays.cases[case].variables[name].unit
            if a.shape != b.shape or a.dtype != b.dtype:
                here, there = (f"{of.dtype}, shape {of.shape}" for of in (a, b))
                yield Row(DIFFERS, what, here, there)
            elif np.array_equal(a, b):
                yield Row(EQUAL, what, str(a.shape), str(b.shape))
            else:
                yield _largest(what, (case, name), a, b, unit, spec.tolerances)


def _largest(
    what: str,
    names: tuple[str, ...],
    a: np.ndarray,
    b: np.ndarray,
    unit: str | list[str],
    tolerances: Mapping[str, tuple[float, float]],
) -> Row:
    """Return the row of two numbers or arrays: of the value that exceeds its tolerance most.

    Args:
        what: the text of the row; the place in an array is added.
        names: of the metric and its group, or of the case and the array. The first with
            a tolerance of its own decides, else the unit.
        a: those of the old side.
        b: those of the new side, of the same shape.
        unit: a list if the last axis has DOFs.
        tolerances: by name or unit.
    """
    units = np.broadcast_to(np.array(unit), a.shape)
    own = next((tolerances[name] for name in names if name in tolerances), None)
    by_unit = {} if np.issubdtype(a.dtype, np.integer) else tolerances
    each = [own or by_unit.get(str(u), (0.0, 0.0)) for u in units.flat]
    limits = np.reshape(each, (*a.shape, 2))
    here, there = a.astype(np.float64), b.astype(np.float64)
    delta, room = there - here, allowed(here, there, limits[..., 0], limits[..., 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(
            delta == 0, 0.0, np.abs(delta) / room
        )  # infinite without a tolerance
    unbound = np.isinf(shares)
    rank = np.where(unbound, np.abs(delta), 0) if unbound.any() else shares
    at = np.unravel_index(np.argmax(rank if rank.any() else np.abs(delta)), a.shape)
    state = DIFFERS if shares[at] > 1 else WITHIN if delta[at] else EQUAL
    place = f"[{', '.join(map(str, at))}]" if at else ""
    old, new, apart, limit = (
        six_digits(float(x[at]), str(units[at])) for x in (here, there, delta, room)
    )
    return Row(state, f"{what}{place}", old, new, apart, limit, float(shares[at]))
