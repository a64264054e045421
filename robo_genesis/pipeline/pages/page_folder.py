"""An executed page in its folder: what was run, the outputs, and the files that the run left.

page.json        the page, its code and run, and a digest of each other file
executed.ipynb   the page's code cells with their outputs
outputs/         what the run left: `<backend>/`, the evidence bundle, and the page's own files
"""

import shutil
from collections.abc import Sequence
from pathlib import Path

import nbformat
from nbformat import NotebookNode
from pydantic import ValidationError

from robo_genesis.core.files import replaced
from robo_genesis.core.project import (
    ENGINE,
    ProjectError,
    installed_version,
    without_folders,
)
from robo_genesis.evidence.bundle import MANIFEST, Sha256, Strict, list_files

from .book import Page, code_cells, code_digest
from .outputs import keep_outputs

RECORD, NOTEBOOK, OUTPUTS = "page.json", "executed.ipynb", "outputs"
SECONDS = "cell_seconds"  # In the metadata of the notebook


class PageRefused(ProjectError):  # noqa: N818 - the word of the domain, as for bundles
    """A folder is not an executed page as it was stored."""


class Record(Strict):
    """`page.json`: what was executed, with what, and the files that the run left.

    `code` is the digest of the page's own code, `engine` its version, None if it is
    unknown. `seconds` is the duration of the execution; `files` maps names to digests.
    """

    code: Sha256
    engine: str | None
    seconds: float
    files: dict[str, Sha256]


def write_page(
    place: Path,
    page: Page,
    notebook: NotebookNode,
    left: Path,
    seconds: float,
    cell_seconds: Sequence[float],
) -> None:
    """Put an executed page into its place in one move; an older one is replaced.

    Args:
        place: the page's folder, named by its fingerprint.
        page: the page that was executed.
        notebook: its cells with their outputs.
        left: the folder with the files that the run left; used if the page declares a
            bundle.
        seconds: how long the execution took.
        cell_seconds: how long each cell with code took.

    Raises:
        OSError: the folder cannot be written.
    """
    place.parent.mkdir(parents=True, exist_ok=True)
    with replaced(place) as fresh:
        fresh.mkdir()
        code = NotebookNode(notebook | {"cells": code_cells(notebook)})
        code.metadata[SECONDS] = list(cell_seconds)
        nbformat.write(code, fresh / NOTEBOOK)
        if page.declares_bundle:
            shutil.copytree(left, fresh / OUTPUTS)
            if bundle := find_bundle(fresh / OUTPUTS):
                keep_outputs(bundle, notebook)
        record = Record(
            code=code_digest(page),
            engine=installed_version(ENGINE),
            seconds=round(seconds, 3),
            files=list_files(fresh, RECORD),
        )
        (fresh / RECORD).write_text(
            record.model_dump_json(indent=1) + "\n", encoding="utf8"
        )


def read_record(place: Path) -> Record:
    """Return what the record of an executed page says.

    Raises:
        PageRefused: it is missing or not what `write_page` writes.
    """
    try:
        return Record.model_validate_json((place / RECORD).read_bytes())
    except (OSError, ValidationError) as error:
        raise PageRefused(
            f"{place / RECORD} is missing or damaged. Execute the page again.\n{error}"
        ) from error


def read_page(place: Path) -> NotebookNode:
    """Return the notebook of an executed page whose files are as they were stored.

    Raises:
        PageRefused: naming each file that is missing, was added or changed.
    """
    record, digests = read_record(place), list_files(place, RECORD)
    names = {*digests, *record.files}
    damaged = [n for n in sorted(names) if digests.get(n) != record.files.get(n)]
    if damaged:
        raise PageRefused(f"{', '.join(damaged)} changed since {place} was stored.")
    return executed_cells(place)


def executed_cells(place: Path) -> NotebookNode:
    """Return the code cells of a page in its folder, with outputs that name no private folder."""
    text = (place / NOTEBOOK).read_text("utf8")
    return nbformat.reads(without_folders(text), as_version=4)


def find_bundle(left: Path) -> Path | None:
    """Return the bundle among the files that a page left, None if there is none."""
    return next((file.parent for file in sorted(left.glob(f"*/{MANIFEST}"))), None)
