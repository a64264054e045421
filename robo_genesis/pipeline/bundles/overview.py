"""`make verify`: the states of all bundles, or of one.

One line for each bundle that is recorded in the book and for each of the last build:
lesson, backend, state, reason.
"""

from collections.abc import Iterator
from pathlib import Path

from robo_genesis.core.project import BOOK, PUBLISHED
from robo_genesis.core.text import printable

from .status import (
    Status,
    bundle_status,
    recorded_folders,
    recorded_status,
)

NO_BUNDLE = (
    "No bundle is recorded in book/evidence, and none is built. `make book` builds one."
)


def verify(folder: Path | None, book: Path = BOOK) -> int:
    """Print a line for each bundle.

    Args:
        folder: of one bundle; None for all of a book.
        book: the folder of the pages.

    Returns:
        0 all verified, or no bundle; 1 any is inconclusive, stale, failed or refused.
    """
    if folder:
        bundles = [(folder.parent.name, bundle_status(folder, book=book))]
    else:
        bundles = list(all_bundles(book))
    print(*[line(*bundle) for bundle in bundles] or [NO_BUNDLE], sep="\n")
    return int(any(status.state != "verified" for _, status in bundles))


def all_bundles(book: Path) -> Iterator[tuple[str, Status]]:
    """Yield (place, status) of the recorded bundles, then of the last build's."""
    for folder in recorded_folders(book):
        lesson, backend = folder.parts[-2:]
        yield f"{lesson} recorded", recorded_status(book, lesson, backend)
    for folder in recorded_folders(book / PUBLISHED):
        lesson = folder.parent.name
        yield f"{lesson} built", bundle_status(folder, lesson, "lab")


def line(place: str, status: Status) -> str:
    """Return one bundle's line."""
    why = status.reason or status.sentence
    return printable(f"{place:14} {status.backend:8} {status.state:12} {why}")
