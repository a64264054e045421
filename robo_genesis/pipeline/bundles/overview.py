"""`make verify`: the states of all bundles, or of one, with what its refusal means.

One line for each bundle that is recorded in the book and for each of the last build:
lesson, backend, state, reason. For one folder, also what a refusal means for somebody
who recorded it at home.
"""

from collections.abc import Iterator
from pathlib import Path

from robo_genesis.core.project import BOOK, PUBLISHED
from robo_genesis.core.text import printable
from robo_genesis.evidence.bundle import read_manifest

from .status import (
    Status,
    bundle_status,
    recorded_folders,
    recorded_status,
)

NO_BUNDLE = (
    "No bundle is recorded in book/evidence, and none is built. `make book` builds one."
)


OWN = "Otherwise your bundle answers your own question and is not evidence for the course's page."
EDITED = (
    "The recorded {} are not those of the recorded {}. If you edited neither file, your copy of "
    "the course {}: use one copy for both."
)

# What a refusal means for somebody who recorded a bundle at home, by its code; other
# codes mean damage, for which the message is enough.
ADVICE = {
    "stale": "Engine, settings, cells or modules differ from those of this course. Install the "
    "versions of the lock (pip install -r requirements.lock), then run the unchanged page "
    f"again. {OWN}",
    "older-schema": "The bundle was recorded with an older state of this course. "
    "Run the page again with the present one.",
    "failed": "The files are sound, but a check of the run itself failed. If you changed the "
    "experiment, this can be your result; otherwise, restart the kernel and run all cells.",
    "metrics": EDITED.format("metrics", "arrays", "computes metrics in another way"),
    "checks": EDITED.format("outcomes of the checks", "runs", "has other checks"),
    "cases": f"The bundle does not have exactly the page's runs. Run the page again. {OWN}",
}

RUN_BY_HAND = (
    "A notebook that is run by hand does not name its code cells, so nobody can tell whether they "
    "are the page's. To record them, run: make evidence LESSON={lesson} BACKEND=cpu TO=folder."
)


def verify(folder: Path | None, book: Path = BOOK) -> int:
    """Print a line for each bundle, and advice for one folder.

    Args:
        folder: of one bundle; None for all of a book.
        book: the folder of the pages.

    Returns:
        0 all verified, or no bundle; 1 any is inconclusive, stale, failed or refused.
    """
    notes: list[str] = []
    if folder:
        status, notes = one_bundle(folder, book)
        bundles = [(folder.parent.name, status)]
    else:
        bundles = list(all_bundles(book))
    lines = [line(*bundle) for bundle in bundles] or [NO_BUNDLE]
    print(*lines, *map(printable, notes), sep="\n")
    return int(any(status.state != "verified" for _, status in bundles))


def all_bundles(book: Path) -> Iterator[tuple[str, Status]]:
    """Yield (place, status) of the recorded bundles, then of the last build's."""
    for folder in recorded_folders(book):
        lesson, backend = folder.parts[-2:]
        yield f"{lesson} recorded", recorded_status(book, lesson, backend)
    for folder in recorded_folders(book / PUBLISHED):
        lesson = folder.parent.name
        yield f"{lesson} built", bundle_status(folder, lesson, "lab")


def one_bundle(folder: Path, book: Path) -> tuple[Status, list[str]]:
    """Return the status of one bundle, and lines for the person who recorded it."""
    status = bundle_status(folder, book=book)
    text = ADVICE.get(status.code or "")
    if status.code == "stale":  # so its manifest could be read
        run = read_manifest(folder)
        if run.source.page is None:
            text = RUN_BY_HAND.format(lesson=run.lesson)
    return status, [f"What this means: {text}"] if text else []


def line(place: str, status: Status) -> str:
    """Return one bundle's line."""
    text = status.reason
    if not text and status.manifest:
        run = status.manifest
        text = (
            f"run {run.run_id[:8]} of {run.started[:10]}, Genesis {run.engine.version}"
        )
    return printable(f"{place:14} {status.backend:8} {status.state:12} {text}")
