"""Entries of the ledger: facts of runs, items with their digests, files to download."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .runs import PageRun

LEDGER = "evidence/ledger"  # The page

# How the line below an item begins whose runs are all accepted.
MEASURED, PRINTED = "Measured", "Printed by this run"

# Kinds of items without evidence of a run, each with the line below it.
UNMEASURED = {
    "illustration": "Illustration, not measured.",
    "settings": "Chosen, not measured.",
}


@dataclass(frozen=True, slots=True)
class Item:
    """One figure, table or camera frame, printed output, illustration, or table of settings.

    `runs` are the keys of the runs that made it, none for the last two kinds. `file` is
    the picture's path below the book, or of a table or text the name of its file;
    `data` is the content of that file, None for a picture.
    """

    kind: str
    title: str
    docname: str
    anchor: str
    runs: tuple[str, ...]
    sha256: str
    file: str
    data: bytes | None = None

    @property
    def row(self) -> str:
        """The anchor of its row in the ledger."""
        return f"row-{self.docname}-{self.anchor}".replace("/", "-").lower()


def provenance(kind: str, runs: Sequence[PageRun]) -> str:
    """Return the line below an item, without its link.

    Args:
        kind: of the item.
        runs: the runs that made it, none for a kind that no run makes.
    """
    if kind in UNMEASURED:
        return UNMEASURED[kind]
    lacking = [run.status.badge for run in runs if run.manifest is None]
    if lacking:
        return f"No accepted evidence: {', '.join(lacking)}."
    origins = (
        f"on {run.status.backend} · Genesis {accepted.engine.version} · run {accepted.run_id[:8]}"
        for run in runs
        if (accepted := run.manifest)
    )
    return f"{PRINTED if kind == 'printed' else MEASURED} {' and '.join(origins)}"


def picture_kind(path: Path) -> str:
    """Return the kind of a measured picture: a camera frame has pixels, a figure has lines."""
    is_raster = path.suffix != ".svg" or b"<image" in path.read_bytes()
    return "camera frame" if is_raster else "figure"


def csv_bytes(rows: Sequence[Sequence[str]]) -> bytes:
    """Return the rows of a table, its head first, as CSV (RFC 4180, UTF-8)."""
    stream = io.StringIO()
    csv.writer(stream).writerows(rows)
    return stream.getvalue().encode()
