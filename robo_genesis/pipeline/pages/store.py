"""The store of executed pages, `<page>/<fingerprint>/`, and what goes into it from elsewhere.

Each folder holds one executed page; see `page_folder`.
"""

import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from robo_genesis.core.files import NEXT, OLD, replaced, settle
from robo_genesis.core.project import ROOT
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.fingerprint import page_fingerprint
from robo_genesis.pipeline.pages.folder import (
    HIDDEN,
    RECORD,
    PageRefused,
    Record,
    StoreError,
    plain_files,
    read_record,
    recorded_bundle,
    require_this_page,
)
from robo_genesis.pipeline.pages.results import PageResult, Status, unexpected_outcome
from robo_genesis.pipeline.pages.sources import Tree

Verify = Callable[[Path, str], Any]
"""Takes a bundle's folder and its run id; returns the manifest or raises BundleRefused."""

KEPT = 3
"""Folders that are kept of each page; RENDER=0 and RENDER=1 have one each."""
AGAIN = "Execute the page again, from this commit and this lock: make execute PAGE={} TO=folder"


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
    store, tree = store.absolute(), Tree(root)
    return {
        page.docname: store / _folder(page) / page_fingerprint(page, root, environment, tree)
        for page in pages
    }


def _folder(page: Page) -> str:
    """Return a page's name as that of a folder."""
    return page.docname.replace("/", "--")


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
    notebook = require_this_page(place, record, page, place.name)
    outcome = unexpected_outcome(page, notebook)
    status: Status = "failed" if outcome else "reused"
    return PageResult(
        page, status, 0.0, record.run_id, recorded_bundle(place, record), outcome, place
    )


def folders(store: Path, page: Page) -> list[Path]:
    """Return the folders that the store has of a page, the newest first."""
    found = [
        path for path in (store / _folder(page)).glob("*/") if not path.name.startswith(HIDDEN)
    ]
    return sorted(found, key=lambda path: path.stat().st_mtime, reverse=True)


def last_record(store: Path, page: Page) -> Record | None:
    """Return the record of the last stored execution of a page, None if there was none."""
    with suppress(PageRefused, IndexError):
        return read_record(folders(store, page)[0])
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


def require_export_folder(to: Path) -> None:
    """Require a folder that is new, or holds nothing but executed pages.

    Raises:
        StoreError: something else is in it.
    """
    held = sorted(to.iterdir()) if to.is_dir() else []
    others = [path for path in held if not (path / RECORD).is_file()]
    if others:
        raise StoreError(
            f"TO={to} holds {others[0].name}, which is not an executed page. Name a new folder, "
            "or one that holds only exported pages."
        )


def export_page(result: PageResult, to: Path) -> Path:
    """Copy one executed page, whole or not at all.

    Args:
        result: the result of a page that did not fail.
        to: gets a folder named by the page, which replaces an older one.

    Returns:
        The page's folder.

    Raises:
        StoreError: the folder holds something else.
        OSError: it cannot be written.
    """
    assert result.folder is not None  # only a failed page has none
    require_export_folder(to)
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
    for place in exported_folders(source):
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


def exported_folders(source: Path) -> list[Path]:
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
        notebook = require_this_page(place, record, page, into[page.docname].name)
        if failure := unexpected_outcome(page, notebook):
            raise PageRefused("outcome", f"{failure.error}: {failure.message}")
        if bundle := recorded_bundle(place, record):
            verify(bundle, record.run_id)
    except BundleRefused as error:
        raise PageRefused("bundle", f"its bundle is refused: {error} {again}") from error
    except PageRefused as error:
        raise PageRefused(error.code, f"{str(error).partition(': ')[2]} {again}") from error
    return record
