"""An executed page in its folder: what was run, the outputs, and the files that the run left.

page.json        the page, its code and run, and a digest of each other file
executed.ipynb   the page's code cells with their outputs
outputs/         what the run left: `<backend>/`, the evidence bundle, and the page's own files

The folder has this form wherever it is: in the store of the cache, and in the folder
    that one
machine fills with `make execute` and another builds from with `make book
EXECUTED=folder`.
"""

import os
import shutil
import stat
from collections.abc import Sequence
from pathlib import Path

import nbformat
from nbformat import NotebookNode
from pydantic import ValidationError

from robo_genesis.core.files import replaced
from robo_genesis.core.project import ENGINE, ProjectError, installed_version
from robo_genesis.evidence.bundle import sha256
from robo_genesis.evidence.fields import RunId, Sha256, Strict
from robo_genesis.pipeline.pages.book import Page, code_digest, code_of
from robo_genesis.pipeline.pages.printed import keep_outputs
from robo_genesis.pipeline.pages.results import PageResult, find_bundle

RECORD, NOTEBOOK, OUTPUTS = "page.json", "executed.ipynb", "outputs"

# Is added to a folder of the store whose bundle was refused: `require_this_page`
# refuses it.
MARK = "refused-by-a-build.txt"
SIZE_LIMIT = 64 * 2**20  # Bytes of one file; those of a lesson have under 2 MiB
FILES_LIMIT = 500


class PageRefused(ProjectError):  # noqa: N818 - the word of the domain, as for bundles
    """A folder is not this page as this checkout executes it. `code` is stable."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(f"{code}: {message}")
        self.code = code


class Record(Strict):
    """`page.json`: what was executed, with what, and the files that the run left.

    `fingerprint` names everything that decides outputs, `code` is the digest of the
    page's own code. `engine` is its version, None if it is unknown. `seconds` is the
    duration of the execution, `cell_seconds` that of each cell with code; `files` maps
    names to digests.
    """

    docname: str
    lesson: str | None
    page: str | None
    fingerprint: str
    code: Sha256
    run_id: RunId
    engine: str | None
    seconds: float
    cell_seconds: list[float]
    files: dict[str, Sha256]


def write_page(
    place: Path,
    page: Page,
    notebook: NotebookNode,
    left: Path,
    run_id: str,
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
        run_id: of the run.
        seconds: how long the execution took.
        cell_seconds: how long each cell with code took.

    Raises:
        PageRefused: the run left a link, a device, or too much.
        OSError: the folder cannot be written.
    """
    place.parent.mkdir(parents=True, exist_ok=True)
    with replaced(place) as fresh:
        fresh.mkdir()
        code = [cell for cell in notebook.cells if cell.cell_type == "code"]
        nbformat.write(NotebookNode(notebook | {"cells": code}), fresh / NOTEBOOK)
        if page.declares_bundle:
            shutil.copytree(left, fresh / OUTPUTS, symlinks=True)
            if bundle := find_bundle(fresh / OUTPUTS, run_id):
                keep_outputs(bundle, notebook)
        record = Record(
            docname=page.docname,
            lesson=page.lesson,
            page=page.page,
            fingerprint=place.name,
            code=code_digest(page),
            run_id=run_id,
            engine=installed_version(ENGINE),
            seconds=round(seconds, 3),
            cell_seconds=list(cell_seconds),
            files={name: sha256(fresh / name) for name in sorted(plain_files(fresh))},
        )
        (fresh / RECORD).write_text(
            record.model_dump_json(indent=1) + "\n", encoding="utf8"
        )


def plain_files(folder: Path) -> list[str]:
    """Return the names of the files below a folder.

    Raises:
        PageRefused: there is a link, a device, a file that is too big, or too many
            files. None was opened.
    """
    names: list[str] = []
    for here, folders, files in os.walk(folder):
        for path in (Path(here, name) for name in (*folders, *files)):
            found, name = path.lstat(), path.relative_to(folder).as_posix()
            if stat.S_ISDIR(found.st_mode):
                continue
            reason = (
                ""
                if stat.S_ISREG(found.st_mode)
                else "is a link or device, no plain file"
            )
            if found.st_size > SIZE_LIMIT or len(names) == FILES_LIMIT:
                reason = f"exceeds a limit: at most {FILES_LIMIT} files, each of {SIZE_LIMIT} bytes"
            if reason:
                raise PageRefused(
                    "files", f"{name} {reason}. Let the page leave only plain files."
                )
            names.append(name)
    return names


def read_record(place: Path) -> Record:
    """Return what the record of an executed page says.

    Raises:
        PageRefused: it is missing or not what `write_page` writes, or a file is not a
            plain one.
    """
    plain_files(place)  # before any is read
    try:
        return Record.model_validate_json((place / RECORD).read_bytes())
    except (OSError, ValidationError) as error:
        what = f"{RECORD} is not what `make execute` writes. Execute the page again."
        raise PageRefused("record", f"{what}\n{error}") from error


def require_this_page(
    place: Path, record: Record, page: Page, fingerprint: str
) -> NotebookNode:
    """Return the notebook of a folder that holds a page as this checkout executes it.

    Raises:
        PageRefused: it says what was found and what is valid.
    """
    present = set(plain_files(place)) - {RECORD}
    if (record.docname, record.lesson, record.page) != (
        page.docname,
        page.lesson,
        page.page,
    ):
        raise PageRefused(
            "page",
            f"it is of {record.docname} ({record.lesson}/{record.page}), expected was "
            f"{page.docname} ({page.lesson}/{page.page}).",
        )
    absent = sorted({NOTEBOOK, *record.files} - present)
    own = f"{OUTPUTS}/" if page.declares_bundle else NOTEBOOK
    others = {
        name for name in present if not (name == NOTEBOOK or name.startswith(own))
    }
    others |= present - record.files.keys()
    if absent or others:
        raise PageRefused(
            "files", f"absent are {absent}, not of this page {sorted(others)}."
        )
    changed = sorted(
        name for name in present if sha256(place / name) != record.files[name]
    )
    if changed:
        raise PageRefused("digest", f"{changed} changed since it was stored.")
    try:
        notebook = nbformat.reads((place / NOTEBOOK).read_text("utf8"), as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat passes on a dozen kinds of exceptions
        raise PageRefused(
            "notebook", f"{NOTEBOOK} is not a notebook: {error}"
        ) from error
    timed = sum(
        bool(cell.source.strip()) for cell in notebook.cells if cell.cell_type == "code"
    )
    if len(record.cell_seconds) != timed:
        seconds = len(record.cell_seconds)
        raise PageRefused(
            "record", f"it has the times of {seconds} cells, expected {timed}."
        )
    cells = code_and_kernel(notebook) == code_and_kernel(page.notebook)
    if not cells or record.code != code_digest(page):
        raise PageRefused("code", f"its code cells are not those of {page.path}.")
    if record.fingerprint != fingerprint:
        raise PageRefused(
            "fingerprint",
            f"its fingerprint is {record.fingerprint}, here it is {fingerprint}: lock, installed "
            "packages, Python, RENDER, the engine's switches or the package differ.",
        )
    metadata = notebook.metadata.get("robo_genesis")
    run_id = metadata.get("run_id") if isinstance(metadata, dict) else None
    if run_id != record.run_id:
        raise PageRefused(
            "run", f"{NOTEBOOK} is of run {run_id}, {RECORD} of {record.run_id}."
        )
    if page.declares_bundle and find_bundle(place / OUTPUTS, record.run_id) is None:
        raise PageRefused(
            "bundle", f"it has no evidence bundle of run {record.run_id}."
        )
    return notebook


def code_and_kernel(notebook: NotebookNode) -> tuple[list[str], str | None]:
    """Return the digests of a notebook's code cells and the name of the kernel that executes them.

    Comments and layout of the cells do not count.
    """
    return code_of(notebook).digests, notebook.metadata.get("kernelspec", {}).get(
        "name"
    )


def stored_notebook(result: PageResult) -> NotebookNode:
    """Return the code cells of a page that was executed, with their outputs."""
    return nbformat.read(result.folder / NOTEBOOK, as_version=4)
