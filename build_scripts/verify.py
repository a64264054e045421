"""Verify evidence: `make verify` (BUNDLE=path checks one folder).

One line for each bundle that is recorded in the book and for each of the last build:
lesson, backend, state, reason. For one folder, also what a refusal means for somebody
who recorded it at home, and how its numbers differ from the last build's run on the CPU
of the same page.
Exit status: 0 all verified, or no bundle; 1 any is inconclusive, stale, failed or
    refused.
"""

import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from robo_genesis.core.project import BOOK, PUBLISHED
from robo_genesis.core.text import printable
from robo_genesis.evidence import bundle_files, report
from robo_genesis.evidence.advice import advice
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles import status as states
from robo_genesis.pipeline.bundles.status import Status, bundle_status, recorded_folders
from robo_genesis.pipeline.command import path, run


def all_bundles() -> Iterator[tuple[str, Status]]:
    """Yield (place, status) of the recorded bundles, then of the last build's."""
    for folder in recorded_folders(BOOK):
        lesson, backend = folder.parts[-2:]
        labs = {lesson: built(lesson)}
        yield (
            f"{lesson} recorded",
            states.recorded_status(BOOK, lesson, backend, labs=labs),
        )
    for folder in recorded_folders(BOOK / PUBLISHED):
        lesson = folder.parent.name
        yield f"{lesson} built", bundle_status(folder, lesson, "lab")


def built(lesson: str) -> Path:
    """Return the folder of the last build's bundle of a lab, which may be missing."""
    return BOOK / PUBLISHED / "evidence" / lesson / "cpu"


def one_bundle(folder: Path) -> tuple[Status, list[str]]:
    """Return the status of one bundle, and lines for the person who recorded it."""
    predicate = None
    with suppress(BundleRefused, OSError):
        bundle_files.scan(folder)
        predicate = read_manifest(folder).predicate
    lab = (
        built(predicate.lesson)
        if predicate and predicate.page == states.RECORDED_PAGE
        else None
    )
    runs = [lab] if lab and lab.is_dir() else []
    status = bundle_status(folder, book=BOOK, cpu_runs=runs)
    lines = []
    if status.code:
        changed = (
            states.changes(read_manifest(folder), BOOK)
            if status.code == "stale"
            else []
        )
        kinds = tuple(dict.fromkeys(kind for kind, _ in changed))
        lines += [
            f"What this means: {text}" for text in advice(status.code, kinds, predicate)
        ]
    if runs and folder.resolve() != runs[0].resolve():
        lines += compared(runs[0], folder)
    return status, lines


def compared(reference: Path, folder: Path) -> list[str]:
    """Return lines that compare a bundle of a lab with this build's run on the CPU."""
    try:
        text = report.summary(compare(reference, folder)).splitlines()
    except BundleRefused as refusal:
        return [f"It cannot be compared with this build's run on the CPU: {refusal}"]
    return ["Compared with this build's run on the CPU (build → yours):", *text]


def line(place: str, status: Status) -> str:
    """Return one bundle's line."""
    text = status.reason
    if not text and status.manifest:
        run = status.manifest.predicate
        text = (
            f"run {run.run_id[:8]} of {run.started[:10]}, Genesis {run.engine.version}"
        )
    return printable(f"{place:14} {status.backend:8} {status.state:12} {text}")


def main() -> int:
    """Print the lines and return the exit status."""
    more: list[str] = []
    if bundle := path("BUNDLE"):
        status, more = one_bundle(bundle)
        found = [(bundle.parent.name, status)]
    else:
        found = list(all_bundles())
    none = "No bundle is recorded in book/evidence, and none is built. `make book` builds one."
    print(*[line(*one) for one in found] or [none], *map(printable, more), sep="\n")
    return 0 if all(status.state == "verified" for _, status in found) else 1


if __name__ == "__main__":
    sys.exit(run(main, "verified"))
