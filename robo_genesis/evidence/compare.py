"""Compare two bundles that differ in one thing: the engine's version, or the backend."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.evidence import bundle, sections
from robo_genesis.evidence.bundle import BundleRefused, Predicate
from robo_genesis.evidence.claims import relations
from robo_genesis.evidence.findings import (
    EQUAL,
    NOT_COMPARABLE,
    SEVERITY,
    SHOWN,
    WITHIN,
    Section,
    Side,
    Specification,
    section,
    worst,
)
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons.registry import find_lesson, find_page

LARGEST = 2**53


@dataclass(frozen=True, slots=True)
class Comparison:
    """What two bundles say of one another.

    `axis` says in what they differ, `repeat` where in nothing; `obstacles` why they cannot be
    compared, and then there are no sections. Sections stand worst first.
    """

    old: Predicate
    new: Predicate
    folders: tuple[str, str]
    axis: str
    obstacles: tuple[str, ...]
    notes: tuple[str, ...]
    sections: tuple[Section, ...]

    @property
    def state(self) -> str:
        """The verdict: equal, within tolerance, inconclusive, differs or not comparable."""
        if self.obstacles:
            return NOT_COMPARABLE
        found = worst([f.state for s in self.sections for f in s.findings if f.state != SHOWN])
        moved = any(s.title == "Arrays" and s.state == SHOWN for s in self.sections)
        return WITHIN if found == EQUAL and moved else found


def specification(lesson: str, page: str = "lab") -> Specification:
    """Return what a lesson of this checkout declares of the cases that a page of it runs.

    Raises:
        BundleRefused: there is no such lesson or page.
    """
    try:
        found, run = find_lesson(lesson), find_page(lesson, page)
    except LookupError as error:
        raise BundleRefused("lesson", str(error)) from error
    spec = found.spec
    cases = tuple(spec.CASES) if run.cases is None else run.cases
    metrics = {case: tuple(found.metrics[case].about("unit")) for case in cases}
    relations = tuple(claim for claim in spec.RELATIONS if {*claim[0]} <= {*cases})
    return Specification(lesson, metrics, spec.TOLERANCES, relations)


def specification_of(folder: Path) -> Specification:
    """Return what this checkout declares of the page that a bundle comes from.

    Raises:
        BundleRefused: its manifest cannot be read, or there is no such lesson or page.
    """
    run = bundle.read_manifest(folder).predicate
    return specification(run.lesson, run.page)


def compare(old: Path, new: Path, spec: Specification) -> Comparison:
    """Hold two bundles one against the other.

    Nothing is recomputed: an old bundle's code and engine are gone. Their digests must be right.

    Raises:
        BundleRefused: a bundle cannot be read.
    """
    a, b = read_side(old), read_side(new)
    was, now = a.manifest.predicate, b.manifest.predicate
    differing = axes(was, now)
    obstacles = tuple(_obstacles(was, now, spec))
    if len(differing) > 1:
        obstacles += (f"Two axes differ: {' and '.join(differing)}. Change one at a time.",)
    repeat = "repeat" if was.source == now.source else "same engine and backend, other code"
    axis = " and ".join(differing) or repeat
    parts = () if obstacles else _sections(a, b, spec)
    return Comparison(
        was, now, (a.folder, b.folder), axis, obstacles, tuple(_notes(was, now)), parts
    )


def _sections(old: Side, new: Side, spec: Specification) -> tuple[Section, ...]:
    none = "No performance is recorded yet."
    every = (
        section("Coverage", sections.coverage(old, new, spec)),
        section("Invariants", sections.invariants(old, new)),
        section("Relations", relations(old, new, spec), "The lesson claims no ordering."),
        section("Exact counts", sections.exact(old, new), "There are no counts."),
        section("Values", sections.values(old, new, spec), "There are no values."),
        section("Arrays", sections.arrays(old, new), "There are no arrays."),
        section("Performance", sections.performance(old, new), none),
    )
    return tuple(sorted(every, key=lambda s: -SEVERITY.index(s.state)))


def read_side(folder: Path) -> Side:
    """Read one bundle strictly, and hold what is read against its listed digests.

    Raises:
        BundleRefused: a file is missing, spoiled, or not the one that the manifest lists.
    """
    manifest = bundle.read_manifest(folder)
    listed = {subject.name: subject.digest.sha256 for subject in manifest.subject}
    _hold_digest(folder, "metrics.json", listed)
    _hold_digest(folder, "arrays.json", listed)
    metrics, arrays = bundle.read_metrics(folder), bundle.read_arrays(folder)
    for group, items in metrics.items():
        for name, metric in items.items():
            if abs(metric.value or 0) > LARGEST:
                raise BundleRefused("bad-schema", f"{group}.{name} is larger than 2⁵³.")
    traces = {}
    for case in arrays.cases:
        _hold_digest(folder, f"arrays/{case}.npz", listed)
        try:
            traces[case] = read_any_trace(folder, arrays, case)
        except TypeError as error:
            raise BundleRefused("bad-array", f"arrays/{case}.npz holds no numbers.") from error
    return Side(str(folder), manifest, metrics, arrays, traces)


def _hold_digest(folder: Path, name: str, listed: dict[str, str]) -> None:
    if name not in listed or not (folder / name).is_file():
        raise BundleRefused(
            "files", f"{name} must stand in {folder} and in its manifest. Record it again."
        )
    if bundle.sha256(folder / name) != listed[name]:
        raise BundleRefused(
            "digest",
            f"{name} of {folder} is not what its manifest lists. Record it again.",
        )


def axes(old: Predicate, new: Predicate) -> list[str]:
    """Return each axis in which two bundles differ, with both values."""
    engines = [f"{p.engine.version} (quadrants {p.engine.quadrants_version})" for p in (old, new)]
    backends = [p.backend.actual for p in (old, new)]
    named = (("engine version", engines), ("backend", backends))
    return [f"{axis} {was} → {now}" for axis, (was, now) in named if was != now]


def _obstacles(old: Predicate, new: Predicate, spec: Specification) -> Iterator[str]:
    required = (
        ("lesson", old.lesson, new.lesson),
        ("page", old.page, new.page),
        ("seed", old.seed, new.seed),
        ("precision", old.engine.precision, new.engine.precision),
    )
    for what, was, now in required:
        if was != now:
            yield f"The {what} differs: {was!r} and {now!r}."
    for path, was, now in _unlike(old.parameters, new.parameters, "parameters"):
        yield f"{path} differs: {was} and {now}."
    for word, side in (("old", old), ("new", new)):
        if side.lesson != spec.lesson:
            yield f"The {word} bundle is of {side.lesson!r}, not of {spec.lesson!r}."
        if side.backend.actual != side.backend.actual_at_end:
            actual, end = side.backend.actual, side.backend.actual_at_end
            yield f"The {word} bundle's backend was {actual} at first and {end} at the end."


def _unlike(old: Any, new: Any, path: str) -> Iterator[tuple[str, Any, Any]]:
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(old.keys() | new.keys()):
            yield from _unlike(old.get(key, "absent"), new.get(key, "absent"), f"{path}.{key}")
    elif old != new:
        yield path, old, new


def _notes(old: Predicate, new: Predicate) -> Iterator[str]:
    if old.run_id == new.run_id:
        yield "Both have one run id: one is a copy of the other, or was edited."
    modules = old.source.modules, new.source.modules
    names = sorted(modules[0].keys() | modules[1].keys())
    changed = [name for name in names if modules[0].get(name) != modules[1].get(name)]
    changed += ["the page's cells"] if old.source.page != new.source.page else []
    if changed:
        yield f"The code is not the same, so it may be the cause: {', '.join(changed)}."
    for word, side in (("old", old), ("new", new)):
        if side.git is None or side.git.dirty:
            yield f"The {word} bundle was not recorded from a clean checkout."
    if old.backend.device_name != new.backend.device_name or old.host.cpu != new.host.cpu:
        yield "The devices are not the same."
    if old.environment != new.environment:
        was, now = (
            ", ".join(f"{name}={value}" for name, value in p.environment.items()) or "none"
            for p in (old, new)
        )
        yield f"The engine's switches are not the same: {was}; {now}."
    for word, one, other in (("gained", new, old), ("lost", old, new)):
        for warning in dict.fromkeys(one.warnings):
            if warning not in other.warnings:
                yield f"Engine warning {word}: {warning}"
