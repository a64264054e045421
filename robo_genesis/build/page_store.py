"""The store of executed pages: one folder for each page and fingerprint.

<page>/<fingerprint>/page.json        the page, its code and run, and a digest of each other file
<page>/<fingerprint>/executed.ipynb   the page's code cells with their outputs
<page>/<fingerprint>/outputs/         what the run left: `<backend>/`, the evidence bundle, and the
                                      page's own files

The innermost folder has the same form wherever it is: in the cache, and in the folder that one
machine fills with `make execute` and another builds from with `make book EXECUTED=folder`.
"""

import os
import shutil
import stat
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import nbformat
from nbformat import NotebookNode
from pydantic import ValidationError

from robo_genesis.build.page_results import PageResult, Status, find_bundle, unexpected_outcome
from robo_genesis.core.files import NEXT, OLD, replaced, settle
from robo_genesis.core.project import ENGINE, ROOT, ProjectError, installed_version
from robo_genesis.evidence.bundle import BundleRefused, sha256
from robo_genesis.evidence.fields import RunId, Sha256, Strict
from robo_genesis.lessons.book_pages import Page, code_digest, plain_python
from robo_genesis.lessons.sources import cell_digest, page_fingerprint

Verify = Callable[[Path, str], Any]
"""Takes a bundle's folder and its run id; returns the manifest or raises BundleRefused."""

RECORD, NOTEBOOK, OUTPUTS = "page.json", "executed.ipynb", "outputs"
KEPT = 3
"""Folders that are kept of each page; RENDER=0 and RENDER=1 have one each."""
SIZE_LIMIT = 64 * 2**20
"""Bytes of one file; those of a lesson have under 2 MiB."""
FILES_LIMIT = 500
HIDDEN = "."
"""Begins the names of the folders that replace others, and of those that are replaced."""
AGAIN = "Execute the page again, from this commit and this lock: make execute PAGE={} TO=folder"


class StoreError(ProjectError):
    """Executed pages cannot be exported or imported; nothing was changed."""


class PageRefused(StoreError):  # noqa: N818 - the word of the domain, as for bundles
    """A folder is not this page as this checkout executes it. `code` is stable."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(f"{code}: {message}")
        self.code = code


class Record(Strict):
    """`page.json`: what was executed, with what, and the files that the run left.

    `fingerprint` names everything that decides outputs, `code` is the digest of the page's own
    code. `command` and `engine` are None if they are unknown. `seconds` is the duration of the
    execution, `cell_seconds` that of each cell with code; `files` maps names to digests.
    """

    docname: str
    lesson: str | None
    page: str | None
    fingerprint: str
    code: Sha256
    run_id: RunId
    command: str | None
    engine: str | None
    seconds: float
    cell_seconds: list[float]
    files: dict[str, Sha256]


def places(
    pages: Iterable[Page],
    store: Path,
    root: Path = ROOT,
    environment: Mapping[str, str] | None = None,
) -> dict[str, Path]:
    """Return where the store has each page, or will have it, by name.

    Args:
        pages: the pages of the book.
        store: the folder of all executed pages.
        root: the checkout.
        environment: variables, by default those of this process.
    """
    store = store.absolute()
    return {
        page.docname: store / _folder(page) / page_fingerprint(page, root, environment)
        for page in pages
    }


def _folder(page: Page) -> str:
    """Return a page's name as that of a folder."""
    return page.docname.replace("/", "--")


def write_page(
    place: Path,
    page: Page,
    notebook: NotebookNode,
    left: Path,
    *,
    run_id: str,
    command: str | None,
    seconds: float,
    cell_seconds: Sequence[float],
) -> None:
    """Put an executed page into its place in one move; an older one is replaced.

    Args:
        place: the page's folder, named by its fingerprint.
        page: the page that was executed.
        notebook: its cells with their outputs.
        left: the folder with the files that the run left; used if the page declares a bundle.
        run_id: of the run.
        command: what the run was part of.
        seconds: how long the execution took.
        cell_seconds: how long each cell with code took.

    Raises:
        StoreError: the run left a link, a device, or too much.
        OSError: the folder cannot be written.
    """
    place.parent.mkdir(parents=True, exist_ok=True)
    with replaced(place, HIDDEN) as fresh:
        fresh.mkdir()
        code = [cell for cell in notebook.cells if cell.cell_type == "code"]
        nbformat.write(NotebookNode(notebook | {"cells": code}), fresh / NOTEBOOK)
        if page.declares_bundle:
            shutil.copytree(left, fresh / OUTPUTS, symlinks=True)
        record = Record(
            docname=page.docname,
            lesson=page.lesson,
            page=page.page,
            fingerprint=place.name,
            code=code_digest(page),
            run_id=run_id,
            command=command,
            engine=installed_version(ENGINE),
            seconds=round(seconds, 3),
            cell_seconds=list(cell_seconds),
            files={name: sha256(fresh / name) for name in sorted(plain_files(fresh))},
        )
        (fresh / RECORD).write_text(record.model_dump_json(indent=1) + "\n", encoding="utf8")


def plain_files(folder: Path) -> list[str]:
    """Return the names of the files below a folder.

    Raises:
        PageRefused: there is a link, a device, a file that is too big, or too many files. None was
            opened.
    """
    names: list[str] = []
    for here, folders, files in os.walk(folder):
        for path in (Path(here, name) for name in (*folders, *files)):
            found, name = path.lstat(), path.relative_to(folder).as_posix()
            if stat.S_ISDIR(found.st_mode):
                continue
            if not stat.S_ISREG(found.st_mode):
                raise PageRefused(
                    "files", f"{name} is a link or device. Only plain files are accepted."
                )
            if found.st_size > SIZE_LIMIT or len(names) == FILES_LIMIT:
                raise PageRefused(
                    "files",
                    f"{name} exceeds a limit: at most {FILES_LIMIT} files, of at most {SIZE_LIMIT} "
                    "bytes each. Let the page leave less.",
                )
            names.append(name)
    return names


def stored_result(page: Page, place: Path) -> PageResult | None:
    """Return the result of a page that needs no run, None if the store does not have it.

    Args:
        page: the page now. Its tags and expected exceptions are compared with the stored outputs;
            where they contradict each other, the page has failed.
        place: the page's folder.

    Raises:
        PageRefused: the folder is there, but has changed since it was written.
    """
    settle(place, HIDDEN)
    if not place.is_dir():
        return None
    record = read_record(place)
    notebook = _require_this_page(place, record, page, place.name)
    outcome = unexpected_outcome(page.notebook, notebook)
    status: Status = "failed" if outcome else "reused"
    return PageResult(page, status, 0.0, record.run_id, _bundle(place, record), outcome, place)


def _bundle(place: Path, record: Record) -> Path | None:
    """Return the folder of the bundle of the recorded run."""
    return find_bundle(place / OUTPUTS, record.run_id) if record.lesson else None


def read_record(place: Path) -> Record:
    """Return what the record of an executed page says.

    Raises:
        PageRefused: it is missing or not what `write_page` writes.
    """
    try:
        return Record.model_validate_json((place / RECORD).read_bytes())
    except (OSError, ValidationError) as error:
        raise PageRefused(
            "record",
            f"{RECORD} is not what `make execute` writes. Execute the page again.\n{error}",
        ) from error


def _require_this_page(place: Path, record: Record, page: Page, fingerprint: str) -> NotebookNode:
    """Return the notebook of a folder that holds a page as this checkout executes it.

    Raises:
        PageRefused: it says what was found and what is valid.
    """
    present = set(plain_files(place)) - {RECORD}
    if (record.docname, record.lesson, record.page) != (page.docname, page.lesson, page.page):
        raise PageRefused(
            "page",
            f"it is of {record.docname} ({record.lesson}/{record.page}), expected was "
            f"{page.docname} ({page.lesson}/{page.page}).",
        )
    code = f"its code cells are not those of {page.path}."
    if record.code != code_digest(page):
        raise PageRefused("code", code)
    if record.fingerprint != fingerprint:
        raise PageRefused(
            "fingerprint",
            f"its fingerprint is {record.fingerprint}, here it is {fingerprint}: lock, installed "
            "packages, Python, RENDER, the engine's switches or the package differ.",
        )
    absent = sorted({NOTEBOOK, *record.files} - present)
    own = f"{OUTPUTS}/" if page.declares_bundle else NOTEBOOK
    others = {name for name in present if not (name == NOTEBOOK or name.startswith(own))}
    others |= present - record.files.keys()
    if absent or others:
        raise PageRefused("files", f"absent are {absent}, not of this page {sorted(others)}.")
    changed = sorted(name for name in present if sha256(place / name) != record.files[name])
    if changed:
        raise PageRefused("digest", f"{changed} changed since it was stored.")
    try:
        notebook = nbformat.reads((place / NOTEBOOK).read_text("utf8"), as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat passes on a dozen kinds of exceptions
        raise PageRefused("notebook", f"{NOTEBOOK} is not a notebook: {error}") from error
    if code_and_kernel(notebook) != code_and_kernel(page.notebook):
        raise PageRefused("code", code)
    metadata = notebook.metadata.get("robo_genesis")
    run_id = metadata.get("run_id") if isinstance(metadata, dict) else None
    if run_id != record.run_id:
        raise PageRefused("run", f"{NOTEBOOK} is of run {run_id}, {RECORD} of {record.run_id}.")
    if page.declares_bundle and _bundle(place, record) is None:
        raise PageRefused("bundle", f"it has no evidence bundle of run {record.run_id}.")
    return notebook


def code_and_kernel(notebook: NotebookNode) -> tuple[list[str], str | None]:
    """Return the digests of a notebook's code cells and the name of the kernel that executes them.

    Comments and layout of the cells do not count.
    """
    cells = [cell_digest(source) for source in plain_python(notebook)]
    return cells, notebook.metadata.get("kernelspec", {}).get("name")


def stored_notebook(result: PageResult) -> NotebookNode:
    """Return the code cells of a page that was executed, with their outputs."""
    assert result.folder is not None  # only a failed page has none
    return nbformat.read(result.folder / NOTEBOOK, as_version=4)


def folders(store: Path, page: Page) -> list[Path]:
    """Return the folders that the store has of a page, the newest first."""
    found = [
        path for path in (store / _folder(page)).glob("*/") if not path.name.startswith(HIDDEN)
    ]
    return sorted(found, key=lambda path: path.stat().st_mtime, reverse=True)


def last_seconds(store: Path, page: Page) -> float | None:
    """Return how long the last stored execution of a page took, None if there was none."""
    with suppress(PageRefused, IndexError):
        return read_record(folders(store, page)[0]).seconds
    return None


def forget(store: Path, results: Iterable[PageResult]) -> None:
    """Remove the pages that the book no longer has, and all but the newest folders of the others.

    Args:
        store: the folder of all executed pages.
        results: those of a build that succeeded, one for each executed page of the book.
    """
    kept: set[Path] = set()
    for result in results:
        if result.folder is not None:
            result.folder.touch()
            kept |= {*folders(store, result.page)[:KEPT]}
    kept |= {place.parent for place in kept}
    for path in [*store.glob("*/"), *store.glob("*/*/")]:
        if path not in kept and path.exists():
            shutil.rmtree(path)


def export_page(result: PageResult, to: Path) -> Path:
    """Copy one executed page, whole or not at all.

    Args:
        result: the result of a page that did not fail.
        to: gets a folder named by the page, which replaces an older one.

    Returns:
        The page's folder.

    Raises:
        StoreError: something else has the folder's name.
        OSError: it cannot be written.
    """
    assert result.folder is not None  # only a failed page has none
    place = to / _folder(result.page)
    if place.exists() and not (place / RECORD).is_file():
        raise StoreError(
            f"{place} is not an executed page. Move it away, or name another TO=folder."
        )
    to.mkdir(parents=True, exist_ok=True)
    with replaced(place) as fresh:
        shutil.copytree(result.folder, fresh)
    return place


def import_pages(
    source: Path, pages: Sequence[Page], into: Mapping[str, Path], verify: Verify
) -> list[Record]:
    """Put executed pages into the store, where the build then finds every page of the book.

    All of them are compared with this checkout first. The names and paths that they state are
    compared, never followed, and their bundles are verified as any other.

    Args:
        source: holds the folders that `export_page` wrote, at any depth.
        pages: the pages of the book.
        into: where the store will have each page; see `places`.
        verify: verifies the bundles.

    Returns:
        What was imported, in the order of `pages`.

    Raises:
        StoreError: it names each page that is missing, or each refused one with code and reason.
    """
    if not source.is_dir():
        raise StoreError(
            f"EXECUTED={source} is not a folder. Name the one that `make execute TO=folder` filled."
        )
    known = {page.docname: page for page in pages}
    found: dict[str, tuple[Path, Record]] = {}
    problems = []
    for place in _handed_over(source):
        try:
            record = _accepted(place, known, into, verify)
            if record.docname in found:
                other = found[record.docname][0]
                raise PageRefused("twice", f"{record.docname} is in {other} as well. Remove one.")
            found[record.docname] = place, record
        except PageRefused as error:
            problems.append(f"{place}: {error}")
    if not problems:  # a refused page would be reported as missing as well
        missing = [docname for docname in known if docname not in found]
        problems = [f"{name} is not among them. {AGAIN.format(name)}" for name in missing]
    if problems:
        raise StoreError("\n".join([f"The executed pages in {source} are refused.", *problems]))
    for docname in known:
        into[docname].parent.mkdir(parents=True, exist_ok=True)
        with replaced(into[docname], HIDDEN) as fresh:
            shutil.copytree(found[docname][0], fresh)
    return [found[docname][1] for docname in known]


def _handed_over(source: Path) -> list[Path]:
    """Return the folders that hold a record.

    Left out are folders within another of them, hidden ones, and what a killed `make execute` left
    beside one (see `core.files.settle`).
    """
    found: list[Path] = []
    for path in sorted(source.rglob(RECORD), key=lambda path: len(path.parts)):
        parts = path.relative_to(source).parts
        left_out = any(part.startswith(".") or part.endswith((NEXT, OLD)) for part in parts)
        if not left_out and not any(place in path.parents for place in found):
            found.append(path.parent)
    return sorted(found)


def _accepted(
    place: Path, known: Mapping[str, Page], into: Mapping[str, Path], verify: Verify
) -> Record:
    """Return the record of one handed-over page that fits this checkout.

    Raises:
        PageRefused: it says what was found, what is valid and what to do.
    """
    plain_files(place)
    record = read_record(place)
    page = known.get(record.docname)
    if page is None:
        raise PageRefused(
            "page",
            f"its page is {record.docname!r}. Pages of this book: {', '.join(known)}. Remove it.",
        )
    again = AGAIN.format(page.docname)
    try:
        notebook = _require_this_page(place, record, page, into[page.docname].name)
        if failure := unexpected_outcome(page.notebook, notebook):
            raise PageRefused("outcome", f"{failure.error}: {failure.message}")
        if bundle := _bundle(place, record):
            verify(bundle, record.run_id)
    except BundleRefused as error:
        raise PageRefused("bundle", f"its bundle is refused: {error} {again}") from error
    except PageRefused as error:
        raise PageRefused(error.code, f"{str(error).partition(': ')[2]} {again}") from error
    return record
