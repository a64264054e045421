"""Take over executed pages from elsewhere: all of them, each held to this checkout, or none."""

import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import nbformat
from jupyter_cache.base import CacheBundleIn
from pydantic import ValidationError

from robo_genesis.build.page_cache import PageCache, notebooks_folder, outputs_folder, usable
from robo_genesis.build.page_export import (
    NOTEBOOK,
    OUTPUTS,
    RECORD,
    HandoverError,
    Record,
    own_outputs,
    plain_files,
)
from robo_genesis.build.page_results import find_bundle, unexpected_outcome
from robo_genesis.core.files import NEXT, OLD
from robo_genesis.evidence.bundle import BundleRefused, sha256
from robo_genesis.lessons.book_pages import Page, code_digest

Verify = Callable[[Path, str], Any]

AGAIN = "Execute the page again, from this commit and this lock: make execute PAGE={} TO=folder"


@dataclass(frozen=True, slots=True)
class Executed:
    """One page that was handed over and holds to this checkout; nothing of it is written yet."""

    page: Page
    record: Record
    place: Path
    notebook: nbformat.NotebookNode


def take_over(source: Path, pages: Sequence[Page], folder: Path, verify: Verify) -> list[Record]:
    """Put executed pages into the cache, where the build then finds every page of the book.

    What comes from elsewhere is held to this checkout first, all of it; names and paths that it
    states are compared, never followed, and its bundles are verified as any other.

    Args:
        source: holds the folders that `hand_over` wrote, at any depth.
        pages: the pages of the book.
        folder: the cache folder of the pages, named by their fingerprint.
        verify: takes a bundle's folder and its run id; returns the manifest or raises.

    Returns:
        What was taken over, in the order of `pages`.

    Raises:
        HandoverError: naming each page that is missing, and each that is refused with the reason.
        ProjectError: the cache folder cannot be used.
    """
    if not source.is_dir():
        raise HandoverError(
            f"EXECUTED={source} is no folder. Name the one that `make execute TO=folder` filled."
        )
    known = {page.docname: page for page in pages}
    found: dict[str, Executed] = {}
    problems = []
    for place in _places(source):
        try:
            one = _read(place, known, folder.name, verify)
            twin = found.setdefault(one.page.docname, one)
            if twin is not one:
                raise HandoverError(f"{one.page.docname} is in {twin.place}, too. Remove one.")
        except HandoverError as error:
            problems.append(f"{place}: {error}")
    missing = [docname for docname in known if docname not in found]
    if not problems:  # what is refused need not be missed, too
        problems = [f"{name} is not among them. {AGAIN.format(name)}" for name in missing]
    if problems:
        raise HandoverError("\n".join([f"The executed pages in {source} are refused.", *problems]))
    with usable(folder):
        for docname in known:
            _keep(found[docname], folder)
    return [found[docname].record for docname in known]


def _places(source: Path) -> list[Path]:
    """Return the folders that hold a record.

    What lies within another of them, in a hidden folder, or in what a killed `make execute` left
    beside one (see `publish.settle`) is none.
    """
    found: list[Path] = []
    for path in sorted(source.rglob(RECORD), key=lambda path: len(path.parts)):
        parts = path.relative_to(source).parts
        passed_over = any(part.startswith(".") or part.endswith((NEXT, OLD)) for part in parts)
        if not passed_over and not any(place in path.parents for place in found):
            found.append(path.parent)
    return sorted(found)


def _read(place: Path, known: Mapping[str, Page], fingerprint: str, verify: Verify) -> Executed:
    """Return one executed page after holding it to the page and the surroundings of this checkout.

    Raises:
        HandoverError: with what was given, what is valid and what to do.
    """
    present = set(plain_files(place)) - {RECORD}
    record = _record(place / RECORD)
    page = known.get(record.docname)
    if page is None:
        raise HandoverError(
            f"its page is {record.docname!r}. Pages of this book: {', '.join(known)}. Remove it."
        )
    again = AGAIN.format(page.docname)
    if record.fingerprint != fingerprint:
        raise HandoverError(
            f"its fingerprint is {record.fingerprint}, here it is {fingerprint}: lock, installed "
            f"packages, Python, RENDER, the engine's switches or the package differ. {again}"
        )
    _require_files(place, record, present, own_outputs(Path(OUTPUTS), page).as_posix(), again)
    notebook = _notebook(place / NOTEBOOK, again)
    cache = PageCache(place)  # asked for its digest alone, which counts code and kernel
    code, own_code = (cache.create_hashed_notebook(nb)[1] for nb in (notebook, page.notebook))
    if record.code != code_digest(page) or code != own_code:
        raise HandoverError(f"its code cells are not those of {page.path}. {again}")
    own = notebook.metadata.get("robo_genesis")
    run_id = own.get("run_id") if isinstance(own, dict) else None
    if run_id != record.run_id:
        raise HandoverError(f"{NOTEBOOK} is of run {run_id}, {RECORD} of {record.run_id}. {again}")
    failure = unexpected_outcome(page.notebook, notebook)
    if failure:
        raise HandoverError(f"{failure.error}: {failure.message} {again}")
    if page.declares_bundle:
        bundle = find_bundle(place / OUTPUTS, page, run_id)
        if bundle is None:
            raise HandoverError(f"it has no evidence bundle of run {run_id}. {again}")
        try:
            verify(bundle, run_id)
        except BundleRefused as error:
            raise HandoverError(f"its bundle is refused: {error}") from error
    return Executed(page, record, place, notebook)


def _record(path: Path) -> Record:
    try:
        return Record.model_validate_json(path.read_bytes())
    except ValidationError as error:
        raise HandoverError(
            f"{RECORD} is not what `make execute` writes. Execute the page again.\n{error}"
        ) from error


def _require_files(place: Path, record: Record, present: set[str], own: str, again: str) -> None:
    """Raise HandoverError unless the files are the listed ones, unchanged, and the page's own."""
    absent = sorted({NOTEBOOK, *record.files} - present)
    foreign = {name for name in present if name != NOTEBOOK and not name.startswith(f"{own}/")}
    unlisted = sorted(present - record.files.keys() | foreign)
    if absent or unlisted:
        raise HandoverError(f"absent are {absent}, not of this page {unlisted}. {again}")
    changed = sorted(name for name in present if sha256(place / name) != record.files[name])
    if changed:
        raise HandoverError(f"{changed} changed since the execution. {again}")


def _notebook(path: Path, again: str) -> nbformat.NotebookNode:
    try:
        notebook = nbformat.reads(path.read_text("utf8"), as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat raises what its parts raise: a dozen kinds
        raise HandoverError(f"{NOTEBOOK} is no notebook: {error} {again}") from error
    return notebook


def _keep(one: Executed, folder: Path) -> None:
    """Write one page into the cache. Killed between its two parts, the page counts as not run."""
    if one.page.declares_bundle:
        outputs = own_outputs(outputs_folder(folder), one.page)
        shutil.rmtree(outputs, ignore_errors=True)
        shutil.copytree(own_outputs(one.place / OUTPUTS, one.page), outputs)
    data = {"execution_seconds": one.record.seconds}
    bundle = CacheBundleIn(one.notebook, str(one.page.path.absolute()), data=data)
    cache = PageCache(notebooks_folder(folder))
    cache.cache_notebook_bundle(bundle, check_validity=False, overwrite=True)
