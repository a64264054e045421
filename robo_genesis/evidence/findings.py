"""The rows of a comparison of two bundles, and the states that they can have."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.orderings import BROKEN, HELD, WITHIN_MARGIN, Relation, outcome
from robo_genesis.core.quantities import six_digits
from robo_genesis.core.trace import TimeSeries
from robo_genesis.evidence.bundle import Arrays, JointRecord, Manifest, Metric, by_full_name
from robo_genesis.evidence.trace_files import fields_of

EQUAL, SHOWN, WITHIN, INCONCLUSIVE, DIFFERS, NOT_COMPARABLE = SEVERITY = (
    "equal", "shown", "within tolerance", "inconclusive", "differs", "not comparable",
)  # fmt: skip
"""States from best to worst. A row that is only shown does not affect the verdict."""

VERDICTS = {
    frozenset({HELD}): (EQUAL, "held in both"),
    frozenset({WITHIN_MARGIN}): (INCONCLUSIVE, "inconclusive"),
    frozenset({HELD, WITHIN_MARGIN}): (INCONCLUSIVE, "inconclusive"),
    frozenset({BROKEN}): (DIFFERS, "broken in both"),
    frozenset({HELD, BROKEN}): (DIFFERS, "flipped"),
    frozenset({BROKEN, WITHIN_MARGIN}): (DIFFERS, "broken in one, undecided in the other"),
}
"""State and verdict of a claimed ordering by its outcomes in the two runs.

Two runs that both break an ordering agree, but the claim of the lesson fails.
"""


@dataclass(frozen=True, slots=True)
class PageSpecification:
    """What a lesson declares about the runs of one of its pages.

    `metrics` gives the required metrics of each case; `tolerances` is unit or metric →
    (atol, rtol).
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
        """Whether each check passed; a repeated check passed if all its outcomes passed."""
        passed: dict[str, bool] = {}
        for check in self.manifest.predicate.checks:
            passed[check.name] = check.passed and passed.get(check.name, True)
        return passed


@dataclass(frozen=True, slots=True)
class Finding:
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
    findings: tuple[Finding, ...]
    empty: str = ""

    @property
    def state(self) -> str:
        """State of the worst row, `equal` if there are no rows."""
        return worst([finding.state for finding in self.findings])


def worst(states: Sequence[str]) -> str:
    """Return the worst of some states, `equal` if there are none."""
    return max(states, key=SEVERITY.index, default=EQUAL)


def section(title: str, findings: Iterator[Finding], empty: str = "") -> Section:
    """Return a section with its rows sorted, worst first."""
    rows = sorted(findings, key=lambda f: (-SEVERITY.index(f.state), -f.weight))
    return Section(title, tuple(rows), empty)


def coverage(old: Side, new: Side, spec: PageSpecification) -> Iterator[Finding]:
    """Both sides have the same cases, metrics, checks, labels and joints."""
    metrics = {f"{case}.{name}" for case, names in spec.metrics.items() for name in names}
    yield from _present("case", {*old.traces}, {*new.traces}, {*spec.metrics})
    yield from _present("metric", {*old.numbers}, {*new.numbers}, metrics)
    yield from _present("check", {*old.checks}, {*new.checks}, set())
    if not old.checks and not new.checks:
        yield Finding(DIFFERS, "checks", "none", "none")
    for name in sorted(old.numbers.keys() & new.numbers.keys()):
        here, there = (f"{m.unit}, {m.kind}" for m in (old.numbers[name], new.numbers[name]))
        if here != there:
            yield Finding(DIFFERS, f"unit and class of {name}", here, there)
    for axis in sorted(old.arrays.coords.keys() | new.arrays.coords.keys()):
        labels = [side.arrays.coords.get(axis, []) for side in (old, new)]
        state = EQUAL if labels[0] == labels[1] else DIFFERS
        here, there = (", ".join(of) if state == DIFFERS else str(len(of)) for of in labels)
        yield Finding(state, f"labels of {axis}", here, there)
    if old.arrays.joints or new.arrays.joints:
        yield from _joints(old, new)


def _present(kind: str, old: set[str], new: set[str], expected: set[str]) -> Iterator[Finding]:
    for name in sorted((old | new | expected) - (old & new)):
        here, there = ("present" if name in side else "missing" for side in (old, new))
        yield Finding(DIFFERS, f"{kind} {name}", here, there)
    if old & new:
        state = EQUAL if len(old) == len(new) else SHOWN
        yield Finding(state, f"number of {kind}s", str(len(old)), str(len(new)))


def _joints(old: Side, new: Side) -> Iterator[Finding]:
    """Each joint has the same DOF, type and limits on both sides."""
    here, there = ({j.name: _joint_text(j) for j in side.arrays.joints} for side in (old, new))
    for name in [n for n in here if here[n] != there.get(n, here[n])]:
        yield Finding(DIFFERS, f"joint {name}", here[name], there[name])
    if here == there:
        yield Finding(EQUAL, "joint map", str(len(here)), str(len(there)))


def _joint_text(joint: JointRecord) -> str:
    lower, upper = (
        "no limit" if limit is None else six_digits(limit, joint.unit)
        for limit in (joint.lower, joint.upper)
    )
    places = f"DOF {joint.dof_idx_local}, qpos {joint.q_idx_local}"
    return f"{joint.type_}, {places}, {lower} to {upper}"


def invariants(old: Side, new: Side) -> Iterator[Finding]:
    """Every check passed on both sides, and the engine was the published one."""
    wheels = [side.manifest.predicate.engine.files_match_wheel for side in (old, new)]
    passed = {n: [old.checks[n], new.checks[n]] for n in old.checks if n in new.checks}
    for name, both in (passed | {"engine files match the wheel": wheels}).items():
        here, there = ("passed" if one else "FAILED" for one in both)
        yield Finding(EQUAL if all(both) else DIFFERS, name, here, there)


def relations(old: Side, new: Side, spec: PageSpecification) -> Iterator[Finding]:
    """Both sides show each ordering that the lesson claims."""
    for relation in spec.relations:
        (first, second), metric, claim, margin = relation
        outcomes = [outcome(side.numbers, relation) for side in (old, new)]
        state, verdict = VERDICTS[frozenset(held for held, _ in outcomes)]
        units = [m.unit for side in (old, new) if (m := side.numbers.get(f"{first}.{metric}"))]
        what = f"{metric}: {second} {claim} than {first}, {verdict}"
        here, there = (f"{held}: {text}" for held, text in outcomes)
        allowed = f"margin {six_digits(margin, units[0] if units else '1')}"
        yield Finding(state, what, here, there, allowed=allowed)


def values(
    old: Side, new: Side, kind: str, tolerances: Mapping[str, tuple[float, float]]
) -> Iterator[Finding]:
    """The metrics of one class agree within atol + rtol · the larger magnitude.

    Counts have no tolerance. Performance is shown and does not affect the verdict.
    """
    for name, a in old.numbers.items():
        b = new.numbers.get(name)
        if b is None or not a.kind == b.kind == kind or a.unit != b.unit:
            continue
        text = six_digits(a.value, a.unit), six_digits(b.value, b.unit)
        if kind == "performance":
            yield Finding(SHOWN, name, *text)
            continue
        if a.value is None or b.value is None:
            yield Finding(EQUAL if a.value == b.value else DIFFERS, name, *text)
            continue
        delta, keys = b.value - a.value, (name.split(".")[-1], a.unit)
        atol, rtol = next((tolerances[key] for key in keys if key in tolerances), (0.0, 0.0))
        allowed = atol + rtol * max(abs(a.value), abs(b.value))
        state = EQUAL if not delta else WITHIN if abs(delta) <= allowed else DIFFERS
        weight = abs(delta) / allowed if allowed else abs(delta)
        more = six_digits(delta, a.unit), six_digits(allowed, a.unit)
        yield Finding(state, name, *text, *more, weight)


def arrays(
    old: Side, new: Side, tolerances: Mapping[str, tuple[float, float]]
) -> Iterator[Finding]:
    """Arrays have the same shape, and their values agree within atol + rtol · the larger magnitude.

    A tolerance is declared by the name of an array or by a unit; without one, and for counts,
    values must be equal. The row names the value that exceeds its tolerance most.
    """
    for case in [name for name in old.traces if name in new.traces]:
        for field, (name, *_) in fields_of(old.traces[case]).items():
            a, b = (getattr(side.traces[case], field, np.empty(0)) for side in (old, new))
            what, unit = f"{case} {name}", old.arrays.cases[case].variables[name].unit
            if a.shape != b.shape or a.dtype != b.dtype:
                here, there = (f"{of.dtype}, shape {of.shape}" for of in (a, b))
                yield Finding(DIFFERS, what, here, there)
            elif np.array_equal(a, b):
                yield Finding(EQUAL, what, str(a.shape), str(b.shape))
            else:
                yield _largest(what, a, b, name, unit, tolerances)


def _largest(
    what: str,
    a: np.ndarray,
    b: np.ndarray,
    name: str,
    unit: str | list[str],
    tolerances: Mapping[str, tuple[float, float]],
) -> Finding:
    """Return the row of two different arrays; `unit` is a list if the last axis has DOFs."""
    units = np.broadcast_to(np.array(unit), a.shape)
    declared = {} if np.issubdtype(a.dtype, np.integer) else tolerances
    limits = {u: declared.get(name, declared.get(u, (0.0, 0.0))) for u in {*units.flat}}
    atol, rtol = (np.vectorize(lambda u, k=k: limits[u][k])(units) for k in (0, 1))
    here, there = a.astype(np.float64), b.astype(np.float64)
    delta, allowed = there - here, atol + rtol * np.maximum(np.abs(here), np.abs(there))
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(delta == 0, 0.0, np.abs(delta) / allowed)  # infinite without a tolerance
    over = np.argmax(shares if np.isfinite(shares).all() else np.where(allowed, 0, np.abs(delta)))
    worst_at = np.unravel_index(over, a.shape)
    state = WITHIN if shares[worst_at] <= 1 else DIFFERS
    place, of = ", ".join(map(str, worst_at)), str(units[worst_at])
    old, new, apart, limit = (
        six_digits(float(x[worst_at]), of) for x in (here, there, delta, allowed)
    )
    weight = float(shares[worst_at])
    return Finding(state, f"{what}[{place}]", old, new, apart, limit, weight)
