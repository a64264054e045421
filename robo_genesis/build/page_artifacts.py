"""Executed pages as files, so that one machine executes them and another builds the site.

<page>/page.json        which page, fingerprint, code and run, and a digest of each other file
<page>/executed.ipynb   the page's code cells with their outputs
<page>/outputs/         the files that the run left: the evidence bundle and the page's own files
"""

import os
import shutil
import stat
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import nbformat
from pydantic import ValidationError

from robo_genesis.build.page_cache import (
    PageCache,
    notebooks_folder,
    outputs_folder,
    store,
    usable,
)
from robo_genesis.build.page_results import PageResult, find_bundle, unexpected_outcome
from robo_genesis.core.files import NEXT, OLD, replaced
from robo_genesis.core.project import ProjectError
from robo_genesis.evidence.bundle import BundleRefused, sha256
from robo_genesis.evidence.fields import RunId, Sha256, Strict
from robo_genesis.lessons.book_pages import Page, code_digest

Verify = Callable[[Path, str], Any]
"""Takes a bundle's folder and its run id; returns the manifest or raises BundleRefused."""

RECORD, NOTEBOOK, OUTPUTS = "page.json", "executed.ipynb", "outputs"
SIZE_LIMIT = 64 * 2**20
"""Bytes of one file; those of a lesson have under 2 MiB."""
FILES_LIMIT = 500
AGAIN = "Execute the page again, from this commit and this lock: make execute PAGE={} TO=folder"


class ArtifactError(ProjectError):
    """Executed pages cannot be exported or imported; nothing was changed."""


class Record(Strict):
    """`page.json`: what was executed, and the files that it left.

    `fingerprint` names everything that decides outputs apart from the page's own code, `code` is
    the digest of that code, `seconds` the duration of the execution; `files` maps names to digests.
    """

    docname: str
    fingerprint: str
    code: Sha256
    run_id: RunId
    seconds: float | None
    files: dict[str, Sha256]


def export_page(result: PageResult, folder: Path, to: Path) -> Path:
    """Write one executed page as files, whole or not at all.

    Args:
        result: the result of a page that did not fail.
        folder: the cache folder of the pages, named by their fingerprint.
        to: gets a folder named by the page, which replaces an older one.

    Returns:
        The page's folder.

    Raises:
        ArtifactError: something else has the folder's name.
        OSError: it cannot be written.
    """
    page, place = result.page, to / result.page.docname.replace("/", "--")
    if place.exists() and not (place / RECORD).is_file():
        raise ArtifactError(
            f"{place} is not an executed page. Move it away, or name another TO=folder."
        )
    to.mkdir(parents=True, exist_ok=True)
    cache = PageCache(notebooks_folder(folder))
    cached = cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk)
    with replaced(place) as fresh:
        fresh.mkdir()
        nbformat.write(cached.nb, fresh / NOTEBOOK)
        if page.declares_bundle:
            shutil.copytree(outputs_folder(folder) / _own(page), fresh / OUTPUTS / _own(page))
        record = Record(
            docname=page.docname,
            fingerprint=folder.name,
            code=code_digest(page),
            run_id=result.run_id,
            seconds=cached.record.data.get("execution_seconds"),
            files={name: sha256(fresh / name) for name in sorted(plain_files(fresh))},
        )
        (fresh / RECORD).write_text(record.model_dump_json(indent=1), encoding="utf8")
    return place


def _own(page: Page) -> Path:
    """Return where a page with a bundle leaves its files, below the outputs of all pages."""
    return Path(str(page.lesson), str(page.page))


def plain_files(folder: Path) -> list[str]:
    """Return the names of the files below a folder.

    Raises:
        ArtifactError: there is a link, a device, a file that is too big, or too many files. None
            was opened.
    """
    names: list[str] = []
    for here, folders, files in os.walk(folder):
        for path in (Path(here, name) for name in (*folders, *files)):
            found, name = path.lstat(), path.relative_to(folder).as_posix()
            if stat.S_ISDIR(found.st_mode):
                continue
            if not stat.S_ISREG(found.st_mode):
                raise ArtifactError(f"{name} is a link or device. Only plain files are accepted.")
            if found.st_size > SIZE_LIMIT or len(names) == FILES_LIMIT:
                raise ArtifactError(
                    f"{name} exceeds a limit: at most {FILES_LIMIT} files, of at most {SIZE_LIMIT} "
                    "bytes each. Let the page leave less."
                )
            names.append(name)
    return names


def import_pages(source: Path, pages: Sequence[Page], folder: Path, verify: Verify) -> list[Record]:
    """Put executed pages into the cache, where the build then finds every page of the book.

    All of them are compared with this checkout first. The names and paths that they state are
    compared, never followed, and their bundles are verified as any other.

    Args:
        source: holds the folders that `export_page` wrote, at any depth.
        pages: the pages of the book.
        folder: the cache folder of the pages, named by their fingerprint.
        verify: verifies the bundles.

    Returns:
        What was imported, in the order of `pages`.

    Raises:
        ArtifactError: it names each page that is missing, or each refused one with the reason.
        ProjectError: the cache folder cannot be used.
    """
    if not source.is_dir():
        raise ArtifactError(
            f"EXECUTED={source} is not a folder. Name the one that `make execute TO=folder` filled."
        )
    known = {page.docname: page for page in pages}
    found: dict[str, tuple[Path, Record, nbformat.NotebookNode]] = {}
    problems = []
    for place in _places(source):
        try:
            record, notebook = _accepted(place, known, folder.name, verify)
            if record.docname in found:
                other = found[record.docname][0]
                raise ArtifactError(f"{record.docname} is in {other} as well. Remove one.")
            found[record.docname] = place, record, notebook
        except ArtifactError as error:
            problems.append(f"{place}: {error}")
    if not problems:  # a refused page would be reported as missing as well
        missing = [docname for docname in known if docname not in found]
        problems = [f"{name} is not among them. {AGAIN.format(name)}" for name in missing]
    if problems:
        raise ArtifactError("\n".join([f"The executed pages in {source} are refused.", *problems]))
    with usable(folder):
        for docname, page in known.items():
            # Killed between the two parts, the page counts as not executed.
            place, record, notebook = found[docname]
            if page.declares_bundle:
                outputs = outputs_folder(folder) / _own(page)
                shutil.rmtree(outputs, ignore_errors=True)
                shutil.copytree(place / OUTPUTS / _own(page), outputs)
            store(page, notebook, record.seconds, folder)
    return [found[docname][1] for docname in known]


def _places(source: Path) -> list[Path]:
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
    place: Path, known: Mapping[str, Page], fingerprint: str, verify: Verify
) -> tuple[Record, nbformat.NotebookNode]:
    """Return record and notebook of one exported page that fits this checkout.

    Raises:
        ArtifactError: it says what was found, what is valid and what to do.
    """
    present = set(plain_files(place)) - {RECORD}
    try:
        record = Record.model_validate_json((place / RECORD).read_bytes())
    except ValidationError as error:
        raise ArtifactError(
            f"{RECORD} is not what `make execute` writes. Execute the page again.\n{error}"
        ) from error
    page = known.get(record.docname)
    if page is None:
        raise ArtifactError(
            f"its page is {record.docname!r}. Pages of this book: {', '.join(known)}. Remove it."
        )
    try:
        notebook = _require_same_execution(place, record, page, fingerprint, present)
        if page.declares_bundle:
            bundle = find_bundle(place / OUTPUTS, page, record.run_id)
            if bundle is None:
                raise ArtifactError(f"it has no evidence bundle of run {record.run_id}.")
            verify(bundle, record.run_id)
    except BundleRefused as error:
        raise ArtifactError(f"its bundle is refused: {error}") from error
    except ArtifactError as error:
        raise ArtifactError(f"{error} {AGAIN.format(page.docname)}") from error
    return record, notebook


def _require_same_execution(
    place: Path, record: Record, page: Page, fingerprint: str, present: set[str]
) -> nbformat.NotebookNode:
    """Return the notebook if it is an execution of this page in these surroundings.

    Raises:
        ArtifactError: a file, the fingerprint, the code, the run or an outcome is another one.
    """
    if record.fingerprint != fingerprint:
        raise ArtifactError(
            f"its fingerprint is {record.fingerprint}, here it is {fingerprint}: lock, installed "
            "packages, Python, RENDER, the engine's switches or the package differ."
        )
    own = f"{OUTPUTS}/{_own(page).as_posix()}/"
    absent = sorted({NOTEBOOK, *record.files} - present)
    valid = {name for name in record.files if name == NOTEBOOK or name.startswith(own)}
    if absent or present - valid:
        raise ArtifactError(f"absent are {absent}, not of this page {sorted(present - valid)}.")
    changed = sorted(name for name in present if sha256(place / name) != record.files[name])
    if changed:
        raise ArtifactError(f"{changed} changed since the execution.")
    try:
        notebook = nbformat.reads((place / NOTEBOOK).read_text("utf8"), as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat passes on a dozen kinds of exceptions
        raise ArtifactError(f"{NOTEBOOK} is not a notebook: {error}") from error
    cache = PageCache(place)  # computes the digest of code and kernel, and writes nothing
    code, own_code = (cache.create_hashed_notebook(nb)[1] for nb in (notebook, page.notebook))
    if record.code != code_digest(page) or code != own_code:
        raise ArtifactError(f"its code cells are not those of {page.path}.")
    metadata = notebook.metadata.get("robo_genesis")
    run_id = metadata.get("run_id") if isinstance(metadata, dict) else None
    if run_id != record.run_id:
        raise ArtifactError(f"{NOTEBOOK} is of run {run_id}, {RECORD} of {record.run_id}.")
    failure = unexpected_outcome(page.notebook, notebook)
    if failure:
        raise ArtifactError(f"{failure.error}: {failure.message}")
    return notebook
