"""Compare two bundles that differ in one thing: the engine's version, or the backend."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core.comparison import differences
from robo_genesis.core.text import quoted
from robo_genesis.evidence import bundle, rows
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.evidence.rows import PageSpecification, Section, Side, worst
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons import find_lesson, find_page

SAME = "Both have the same cases, metrics, checks, labels and joints."
NO_PERFORMANCE = "No performance is recorded yet."


@dataclass(frozen=True, slots=True)
class BundleComparison:
    """The result of a comparison.

    `axis` names what differs, or is `repeat`. `obstacles` are the reasons why the two
    cannot be compared; there are no sections then. Sections are sorted, worst first.
    """

    old: Manifest
    new: Manifest
    folders: tuple[str, str]
    axis: str
    obstacles: tuple[str, ...]
    notes: tuple[str, ...]
    sections: tuple[Section, ...]

    @property
    def remarks(self) -> tuple[str, ...]:
        """Obstacles and notes."""
        return self.obstacles + self.notes

    @property
    def state(self) -> str:
        """The verdict: equal, within tolerance, inconclusive, differs or not comparable."""
        if self.obstacles:
            return rows.NOT_COMPARABLE
        return worst(
            [f.state for s in self.sections for f in s.rows if f.state != rows.SHOWN]
        )


def specification(lesson: str, page: str) -> PageSpecification:
    """Return what this checkout declares about the cases of a page.

    Raises:
        BundleRefused: `lesson`, the lesson or the page does not exist.
    """
    try:
        found, run = find_lesson(lesson), find_page(lesson, page)
    except LookupError as error:
        raise BundleRefused("lesson", str(error)) from error
    cases = [case for case in found.spec.CASES if case in run.runs]
    metrics = {case: tuple(found.metrics[case].about("unit")) for case in cases}
    relations = tuple(
        claim for claim in found.spec.RELATIONS if {*claim[0]} <= {*cases}
    )
    return PageSpecification(metrics, found.spec.TOLERANCES, relations)


def compare(old: Path, new: Path) -> BundleComparison:
    """Compare two bundles by what this checkout declares about the page of the new one.

    Nothing is recomputed, because the code and the engine of an old bundle are not
    installed. The digests of both must be right.

    Raises:
        BundleRefused: a bundle cannot be read, its lesson or page does not exist, or
            the two are of different pages.
    """
    a, b = read_side(old), read_side(new)
    was, now = a.manifest, b.manifest
    spec = specification(now.lesson, now.page)
    if (was.lesson, was.page) != (now.lesson, now.page):
        raise BundleRefused(
            "lesson",
            f"{a.folder} is of {was.lesson}/{was.page}, {b.folder} of {now.lesson}/{now.page}. "
            "Give two bundles of the same page.",
        )
    obstacles = tuple(_obstacles(was, now))
    repeat = (
        "repeat" if was.source == now.source else "same engine and backend, other code"
    )
    axis = " and ".join(axes(was, now)) or repeat
    parts = () if obstacles else _sections(a, b, spec)
    return BundleComparison(
        was, now, (a.folder, b.folder), axis, obstacles, tuple(_notes(was, now)), parts
    )


def _sections(old: Side, new: Side, spec: PageSpecification) -> tuple[Section, ...]:
    every = (
        rows.section("Coverage", rows.coverage(old, new, spec), SAME),
        rows.section("Invariants", rows.invariants(old, new)),
        rows.section(
            "Relations",
            rows.relations(old, new, spec),
            "The lesson claims no ordering.",
        ),
        rows.section(
            "Exact counts", rows.values(old, new, spec, "exact"), "There are no counts."
        ),
        rows.section(
            "Values", rows.values(old, new, spec, "value"), "There are no values."
        ),
        rows.section("Arrays", rows.arrays(old, new, spec), "There are no arrays."),
        rows.section(
            "Performance", rows.values(old, new, spec, "performance"), NO_PERFORMANCE
        ),
    )
    return tuple(sorted(every, key=lambda s: -rows.SEVERITY.index(s.state)))


def read_side(folder: Path) -> Side:
    """Read one bundle strictly, with the verifier's own bounds and digests.

    Raises:
        BundleRefused: a file is too large, missing, damaged, or differs from the listed
            one; the message begins with the folder.
    """
    try:
        manifest = bundle.read_manifest(folder)
        bundle.check_files(folder, manifest)
        metrics, arrays = bundle.read_metrics(folder), bundle.read_arrays(folder)
        traces = {case: read_any_trace(folder, arrays, case) for case in arrays.cases}
    except BundleRefused as refusal:
        raise BundleRefused(refusal.code, f"{folder}: {refusal.message}") from refusal
    return Side(str(folder), manifest, metrics, arrays, traces)


def axes(old: Manifest, new: Manifest) -> list[str]:
    """Return each axis in which two bundles differ, with both values."""
    engines = [
        f"{p.engine.version} (quadrants {p.engine.quadrants_version})"
        for p in (old, new)
    ]
    backends = [p.backend.actual for p in (old, new)]
    named = (("engine version", engines), ("backend", backends))
    return [f"{axis} {was} → {now}" for axis, (was, now) in named if was != now]


def _obstacles(old: Manifest, new: Manifest) -> Iterator[str]:
    was_asked, is_asked = (
        {
            "The seed": p.seed,
            "The precision": p.engine.precision,
            "parameters": p.parameters,
        }
        for p in (old, new)
    )
    for path, was, now in differences(was_asked, is_asked):
        yield f"{path} differs: {quoted(was)} and {quoted(now)}."
    for word, side in (("old", old), ("new", new)):
        if side.backend.actual != side.backend.actual_at_end:
            change = f"from {side.backend.actual} to {side.backend.actual_at_end}"
            yield f"The backend of the {word} bundle changed during the run, {change}."
    if len(differing := axes(old, new)) > 1:
        yield f"Two axes differ: {' and '.join(differing)}. Change one at a time."


def _notes(old: Manifest, new: Manifest) -> Iterator[str]:
    if old.run_id == new.run_id:
        yield "Both have the same run id. One is a copy of the other, or was edited."
    changed = [name for name, *_ in differences(old.source.modules, new.source.modules)]
    changed += ["the page's cells"] if old.source.page != new.source.page else []
    if changed:
        yield f"The code differs and may be the cause: {', '.join(changed)}."
    for word, side in (("old", old), ("new", new)):
        if side.git is None or side.git.dirty:
            yield f"The {word} bundle was not recorded from a clean checkout."
    if (
        old.backend.device_name != new.backend.device_name
        or old.host.cpu != new.host.cpu
    ):
        yield "The devices differ."
    if old.environment != new.environment:
        was, now = (
            ", ".join(f"{name}={value}" for name, value in p.environment.items())
            or "none"
            for p in (old, new)
        )
        yield f"The switches of the engine differ: {was}; {now}."
    for word, one, other in (("gained", new, old), ("lost", old, new)):
        for warning in dict.fromkeys(one.warnings):
            if warning not in other.warnings:
                yield f"Engine warning {word}: {warning}"
