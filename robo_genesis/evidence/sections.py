"""Two bundles held one against the other: the rows of each kind of question, orderings apart."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.quantities import six_digits
from robo_genesis.evidence.bundle import JointRecord, Metric
from robo_genesis.evidence.findings import (
    DIFFERS,
    EQUAL,
    SHOWN,
    WITHIN,
    Finding,
    Side,
    Specification,
)
from robo_genesis.evidence.trace_files import fields_of


def coverage(old: Side, new: Side, spec: Specification) -> Iterator[Finding]:
    """Cases, metrics and checks stand on both sides, and say the same of themselves."""
    metrics = {f"{case}.{name}" for case, names in spec.metrics.items() for name in names}
    yield from _present("case", set(old.traces), set(new.traces), set(spec.metrics))
    yield from _present("metric", set(old.numbers), set(new.numbers), metrics)
    yield from _present("check", set(old.checks), set(new.checks), set())
    if not old.checks and not new.checks:
        yield Finding(DIFFERS, "checks", "none", "none")
    for name in sorted(old.numbers.keys() & new.numbers.keys()):
        a, b = old.numbers[name], new.numbers[name]
        if (a.unit, a.kind) != (b.unit, b.kind):
            yield Finding(
                DIFFERS, f"unit and class of {name}", f"{a.unit}, {a.kind}", f"{b.unit}, {b.kind}"
            )
    for axis in sorted(old.arrays.coords.keys() | new.arrays.coords.keys()):
        labels = [side.arrays.coords.get(axis, []) for side in (old, new)]
        state = EQUAL if labels[0] == labels[1] else DIFFERS
        here, there = (", ".join(of) if state == DIFFERS else str(len(of)) for of in labels)
        yield Finding(state, f"labels of {axis}", here, there)
    if old.arrays.joints or new.arrays.joints:
        yield from _joints(old, new)


def _joints(old: Side, new: Side) -> Iterator[Finding]:
    """A name owns the same DOF, with the same type and limits, on both sides."""
    here, there = ({j.name: _owned(j) for j in side.arrays.joints} for side in (old, new))
    for name in [n for n in here if here[n] != there.get(n, here[n])]:
        yield Finding(DIFFERS, f"joint {name}", here[name], there[name])
    if here == there:
        yield Finding(EQUAL, "joint map", str(len(here)), str(len(there)))


def _owned(joint: JointRecord) -> str:
    limits = (
        "no limit" if limit is None else six_digits(limit, joint.unit)
        for limit in (joint.lower, joint.upper)
    )
    places = f"DOF {joint.dof_idx_local}, qpos {joint.q_idx_local}"
    return f"{joint.type_}, {places}, {' to '.join(limits)}"


def _present(kind: str, old: set[str], new: set[str], expected: set[str]) -> Iterator[Finding]:
    for name in sorted(old | new | expected):
        if name not in old or name not in new:
            here, there = ("present" if name in side else "missing" for side in (old, new))
            yield Finding(DIFFERS, f"{kind} {name}", here, there)
    if old & new:
        state = EQUAL if len(old) == len(new) else SHOWN
        yield Finding(state, f"number of {kind}s", str(len(old)), str(len(new)))


def invariants(old: Side, new: Side) -> Iterator[Finding]:
    """Every check passed on both sides, and the engine was the published one."""
    wheels = [side.manifest.predicate.engine.files_match_wheel for side in (old, new)]
    held = {n: [old.checks[n], new.checks[n]] for n in old.checks if n in new.checks}
    for name, both in (held | {"engine files match the wheel": wheels}).items():
        here, there = ("passed" if one else "FAILED" for one in both)
        yield Finding(EQUAL if all(both) else DIFFERS, name, here, there)


def pairs(old: Side, new: Side, kind: str) -> Iterator[tuple[str, Metric, Metric]]:
    """Yield each metric of one class that stands on both sides in the same unit."""
    for name, a in old.numbers.items():
        b = new.numbers.get(name)
        if b is not None and a.kind == b.kind == kind and a.unit == b.unit:
            yield name, a, b


def exact(old: Side, new: Side) -> Iterator[Finding]:
    """Counts are equal."""
    for name, a, b in pairs(old, new, "exact"):
        both = a.value is not None and b.value is not None
        delta = six_digits(b.value - a.value, a.unit) if both else ""  # type: ignore[operator]
        state = EQUAL if a.value == b.value else DIFFERS
        yield Finding(
            state, name, six_digits(a.value, a.unit), six_digits(b.value, b.unit), delta, "0"
        )


def values(old: Side, new: Side, spec: Specification) -> Iterator[Finding]:
    """Measured values agree within atol + rtol · the larger magnitude."""
    for name, a, b in pairs(old, new, "value"):
        text = six_digits(a.value, a.unit), six_digits(b.value, b.unit)
        if a.value is None or b.value is None:
            yield Finding(EQUAL if a.value == b.value else DIFFERS, name, *text)
            continue
        delta = b.value - a.value
        keys = (name.split(".")[-1], a.unit)
        atol, rtol = next((spec.tolerances[k] for k in keys if k in spec.tolerances), (0.0, 0.0))
        allowed = atol + rtol * max(abs(a.value), abs(b.value))
        moved = WITHIN if abs(delta) <= allowed else DIFFERS
        weight = abs(delta) / allowed if allowed else abs(delta)
        yield Finding(
            moved if delta else EQUAL, name, *text,
            six_digits(delta, a.unit), six_digits(allowed, a.unit), weight,
        )  # fmt: skip


def arrays(old: Side, new: Side) -> Iterator[Finding]:
    """The largest difference in every array; another shape is a difference, a distance is shown."""
    for case in [name for name in old.traces if name in new.traces]:
        variables = old.arrays.cases[case].variables
        for field, (name, *_) in fields_of(old.traces[case]).items():
            a, b = (getattr(side.traces[case], field, np.empty(0)) for side in (old, new))
            what, unit = f"{case} {name}", variables[name].unit
            if a.shape != b.shape:
                yield Finding(DIFFERS, what, f"shape {a.shape}", f"shape {b.shape}")
                continue
            apart = float(np.abs(b.astype(np.float64) - a.astype(np.float64)).max(initial=0.0))
            units = unit if isinstance(unit, str) else " or ".join(dict.fromkeys(unit))
            text = f"{a.shape}"
            yield Finding(SHOWN if apart else EQUAL, what, text, text, six_digits(apart, units),
                          weight=apart)  # fmt: skip


def performance(old: Side, new: Side) -> Iterator[Finding]:
    """Speed is shown and decides nothing."""
    for name, a, b in pairs(old, new, "performance"):
        yield Finding(SHOWN, name, six_digits(a.value, a.unit), six_digits(b.value, b.unit))
