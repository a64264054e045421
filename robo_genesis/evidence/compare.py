"""Compare two bundles that differ in one thing: the engine's version, or the backend."""

import shutil
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.core.comparison import Relation, differences
from robo_genesis.core.text import quoted
from robo_genesis.lessons import find_lesson, find_page

from . import bundle, rows
from .bundle import Arrays, Manifest
from .refusals import BundleRefused
from .rows import Section, Side, worst
from .trace_files import read_any_trace, read_run


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
        states = [row.state for part in self.sections for row in part.rows]
        return worst([state for state in states if state != rows.SHOWN])


def claims_of(lesson: str, page: str) -> list[Relation]:
    """Return the orderings that a lesson claims of the cases of a page.

    Raises:
        BundleRefused: `lesson`, the lesson or the page does not exist.
    """
    try:
        relations, runs = (
            find_lesson(lesson).spec.RELATIONS,
            find_page(lesson, page).runs,
        )
    except LookupError as error:
        raise BundleRefused("lesson", str(error)) from error
    return [relation for relation in relations if {*relation[0]} <= {*runs}]


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
    claims = claims_of(now.lesson, now.page)
    if (was.lesson, was.page) != (now.lesson, now.page):
        raise BundleRefused(
            "lesson",
            f"{a.folder} is of {was.lesson}/{was.page}, {b.folder} of {now.lesson}/{now.page}. "
            "Give two bundles of the same page.",
        )
    obstacles = tuple(_obstacles(was, now))
    same_code = was.source == now.source
    repeat = "repeat" if same_code else "same engine and backend, other code"
    axis = " and ".join(axes(was, now)) or repeat
    sections = () if obstacles else tuple(_sections(a, b, claims))
    notes = tuple(_notes(was, now))
    places = (a.folder, b.folder)
    return BundleComparison(was, now, places, axis, obstacles, notes, sections)


def _sections(old: Side, new: Side, claims: Sequence[Relation]) -> list[Section]:
    """Return all sections, the worst first."""
    both, tolerances = (old, new), find_lesson(new.manifest.lesson).spec.TOLERANCES
    sections = (
        rows.section("Coverage", rows.coverage(*both)),
        rows.section("Invariants", rows.invariants(*both)),
        rows.section("Relations", rows.relations(*both, claims)),
        rows.section("Exact counts", rows.values(*both, {}, "exact")),
        rows.section("Values", rows.values(*both, tolerances, "value")),
        rows.section("Arrays", rows.arrays(*both, tolerances)),
        rows.section("Performance", rows.values(*both, {}, "performance")),
    )
    return sorted(sections, key=lambda part: -rows.SEVERITY.index(part.state))


@contextmanager
def bundle_folder(path: Path) -> Iterator[Path]:
    """Yield the folder of a bundle, also of one in an archive as the ledger offers it.

    Raises:
        BundleRefused: `missing`, it is neither a folder nor an archive.
    """
    if path.is_dir():
        yield path
        return
    if not zipfile.is_zipfile(path):
        raise BundleRefused(
            "missing",
            f"{path} is neither a folder nor a zip archive; expected a run's folder, as "
            "outputs/l04/lab/cpu, or its archive.",
        )
    with tempfile.TemporaryDirectory() as folder:
        shutil.unpack_archive(path, folder, "zip")
        yield Path(folder)


def read_trace(folder: Path, arrays: Arrays, case: str, manifest: Manifest) -> Any:
    """Return one run of the kind that its page declares, or of one that fits its arrays."""
    with suppress(LookupError):  # another version of the course has the lesson or page
        page = find_page(manifest.lesson, manifest.page)
        run = page.runs.get(case)
        kind = run.kind if run and run.kind else page.kind
        names = {stored.name for stored in kind.arrays().values()}
        if names == {*arrays.cases[case].variables}:
            return read_run(folder, case, kind)
    return read_any_trace(folder, arrays, case)


def read_side(path: Path) -> Side:
    """Read one bundle, a folder or an archive; its digests must be right.

    Raises:
        BundleRefused: a file is missing, damaged, or differs from the listed one; the
            message begins with the path.
    """
    try:
        with bundle_folder(path) as folder:
            manifest = bundle.read_manifest(folder)
            bundle.check_files(folder, manifest)
            arrays = bundle.read_arrays(folder)
            traces = {
                case: read_trace(folder, arrays, case, manifest)
                for case in arrays.cases
            }
            return Side(
                str(path), manifest, bundle.read_metrics(folder), arrays, traces
            )
    except BundleRefused as refusal:
        raise BundleRefused(refusal.code, f"{path}: {refusal.message}") from refusal


def axes(old: Manifest, new: Manifest) -> list[str]:
    """Return each axis in which two bundles differ, with both values."""
    engines = [
        f"{run.engine.version} (quadrants {run.engine.quadrants_version})"
        for run in (old, new)
    ]
    backends = [run.backend.actual for run in (old, new)]
    named = (("engine version", engines), ("backend", backends))
    return [f"{axis} {was} → {now}" for axis, (was, now) in named if was != now]


def _obstacles(old: Manifest, new: Manifest) -> Iterator[str]:
    asked, asked_now = (
        {
            "The seed": run.seed,
            "The precision": run.engine.precision,
            "parameters": run.parameters,
        }
        for run in (old, new)
    )
    for path, was, now in differences(asked, asked_now):
        yield f"{path} differs: {quoted(was)} and {quoted(now)}."
    if len(differing := axes(old, new)) > 1:
        yield f"Two axes differ: {' and '.join(differing)}. Change one at a time."


def _notes(old: Manifest, new: Manifest) -> Iterator[str]:
    if old.run_id == new.run_id:
        yield "Both have the same run id: one is the other, or a copy of it."
    changed = [name for name, *_ in differences(old.source.modules, new.source.modules)]
    changed += ["the page's cells"] if old.source.page != new.source.page else []
    if changed:
        yield f"The course's code differs and may be the cause: {', '.join(changed)}."
    for word, one, other in (("gained", new, old), ("lost", old, new)):
        for warning in dict.fromkeys(one.warnings):
            if warning not in other.warnings:
                yield f"Engine warning {word}: {warning}"
