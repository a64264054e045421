"""The store of executed pages, `<page>/<fingerprint>/`, and what goes into it from elsewhere.

Each folder holds one executed page; see `page_folder`.
"""

import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from robo_genesis.core.files import put, require_replaceable, require_writable
from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.folder import (
    OUTPUTS,
    RECORD,
    PageRefused,
    Record,
    plain_files,
    read_record,
    require_this_page,
)
from robo_genesis.pipeline.pages.results import PageResult, Status, find_bundle, unexpected_outcome
from robo_genesis.pipeline.pages.sources import Tree, page_fingerprint, require_keyed_imports

Verify = Callable[[Path, str], Any]
"""Takes a bundle's folder and its run id; returns the manifest or raises BundleRefused."""

KEPT = 3
"""Folders that are kept of each page; RENDER=0 and RENDER=1 have one each."""
AGAIN = "Execute these pages again, from this commit and this lock: make execute PAGE=… TO=folder"


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

    Raises:
        ProjectError: Python would run files of the checkout that no fingerprint covers.
    """
    require_keyed_imports(root)
    store, tree = store.absolute(), Tree(root)
    return {
        page.docname: store / _folder(page) / page_fingerprint(page, tree, environment)
        for page in pages
    }


def _folder(page: Page) -> str:
    """Return a page's name as that of a folder."""
    return page.docname.replace("/", "--")


def stored_result(page: Page, place: Path) -> PageResult | None:
    """Return the result of a page that needs no run, None if the store does not have it.

    Args:
        page: the page now.
        place: the page's folder.

    Raises:
        PageRefused: the folder is there, but has changed since it was written.
    """
    return result_of(page, place, place.name) if place.is_dir() else None


def result_of(page: Page, place: Path, fingerprint: str) -> PageResult:
    """Return the result of a page from a folder that holds it as this checkout executes it.

    The tags and expected exceptions of the page are compared with the outputs; where they
    contradict each other, the page has failed.

    Raises:
        PageRefused: the folder is not this page.
    """
    record = read_record(place)
    notebook = require_this_page(place, record, page, fingerprint)
    outcome = unexpected_outcome(page, notebook)
    bundle = find_bundle(place / OUTPUTS, record.run_id)
    status: Status = "failed" if outcome else "reused"
    return PageResult(page, status, 0.0, record.run_id, bundle, outcome, place)


def folders(store: Path, page: Page) -> list[Path]:
    """Return the folders that the store has of a page, the newest first."""
    found = (store / _folder(page)).glob("[!.]*/")
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
        result.folder.touch()
        kept |= {*folders(store, result.page)[:KEPT]}
    kept |= {place.parent for place in kept}
    for path in [*store.glob("*/"), *store.glob("*/*/")]:
        if path not in kept and path.exists():
            shutil.rmtree(path)


def exported(page: Page, to: Path) -> Path:
    """Return the place of a page in a folder that is filled for another machine.

    Raises:
        ProjectError: it cannot be written, or something else is there.
    """
    place = to / _folder(page)
    require_writable(to)
    require_replaceable(place, RECORD)
    return place


def import_pages(
    source: Path, pages: Sequence[Page], into: Mapping[str, Path], verify: Verify
) -> None:
    """Put executed pages into the store, so that none has to run.

    All of them are compared with this checkout first. The names and paths that they state are
    compared, never followed, and their bundles are verified as any other.

    Args:
        source: holds the folders of `exported`, at any depth.
        pages: the pages of the book.
        into: where the store will have each page; see `places`.
        verify: verifies the bundles.

    Raises:
        ProjectError: it names each page that is missing, or each refused one with code and reason.
    """
    if not source.is_dir():
        raise ProjectError(
            f"EXECUTED={source} is not a folder. Name the one that `make execute TO=folder` filled."
        )
    known = {page.docname: page for page in pages}
    found: dict[str, Path] = {}
    problems = []
    for place in exported_folders(source):
        try:
            plain_files(place)  # before any is read
            name = read_record(place).docname
            if name not in known:
                valid = ", ".join(known)
                raise PageRefused("page", f"its page is {name!r}. Pages of this book: {valid}.")
            result = result_of(known[name], place, into[name].name)
            if result.failure:
                raise PageRefused("outcome", f"{result.failure.error}: {result.failure.message}")
            if result.bundle:
                verify(result.bundle, result.run_id)
            if name in found:
                raise PageRefused("twice", f"{name} is in {found[name]} as well. Remove one.")
            found[name] = place
        except PageRefused as error:
            problems.append(f"{place}: {error}")
        except BundleRefused as error:
            problems.append(f"{place}: bundle: its bundle is refused: {error}")
    if not problems:  # a refused page would be reported as missing as well
        problems = [f"{name} is not among them." for name in known if name not in found]
    if problems:
        first = f"The executed pages in {source} are refused."
        raise ProjectError("\n".join([first, *problems, AGAIN]))
    for name, place in found.items():
        put(place, into[name])


def exported_folders(source: Path) -> list[Path]:
    """Return the folders that hold a record, except hidden ones and those within another."""
    found: list[Path] = []
    for path in sorted(source.rglob(RECORD), key=lambda path: len(path.parts)):
        hidden = any(part.startswith(".") for part in path.relative_to(source).parts)
        if not hidden and not any(place in path.parents for place in found):
            found.append(path.parent)
    return sorted(found)
