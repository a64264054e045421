"""The store of executed pages, `<page>/<fingerprint>/`; each folder is one, see `page_folder`."""

import json
import shutil
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from robo_genesis.core.files import write_whole

from .book import Page
from .page_folder import (
    PageRefused,
    Record,
    read_page,
    read_record,
)
from .results import PageResult, unexpected_outcome
from .sources import Tree, page_fingerprint

# Takes a bundle's folder; returns the manifest or raises BundleRefused.
Verify = Callable[[Path], Any]

# What each page took where the table was written, for the estimates of a first build.
SECONDS = "_seconds.json"

KEPT = 3  # Folders that are kept of each page; RENDER=0 and RENDER=1 have one each


def places(pages: Iterable[Page], store: Path) -> dict[str, Path]:
    """Return where the store has each page, or will have it, by name.

    Args:
        pages: the pages of the book.
        store: the folder of all executed pages.
    """
    store, tree = store.absolute(), Tree()
    return {
        page.docname: executions(store, page) / page_fingerprint(page, tree)
        for page in pages
    }


def executions(store: Path, page: Page) -> Path:
    """Return the folder of all executions of a page."""
    return store / page.docname.replace("/", "--")


def stored_result(page: Page, place: Path) -> PageResult | None:
    """Return the result of a page that needs no run, None if the store does not have it.

    Raises:
        PageRefused: the folder is damaged, or its outputs contradict the tags and
            expected exceptions of the page.
    """
    if not place.is_dir():
        return None
    if outcome := unexpected_outcome(page, read_page(place)):
        raise PageRefused(str(outcome))
    return PageResult(page, "reused", place)


def folders(place: Path) -> list[Path]:
    """Return the folders of a page's executions, the newest first."""
    every = place.glob("[!.]*/")
    return sorted(every, key=lambda path: path.stat().st_mtime, reverse=True)


def last_record(place: Path) -> Record | None:
    """Return the record of the last stored execution of a page, None if there was none."""
    with suppress(PageRefused, IndexError):
        return read_record(folders(place)[0])
    return None


def typical_seconds(book: Path) -> dict[str, float]:
    """Return the book's table of what each page took, by name; empty if it has none."""
    table = book / SECONDS
    return json.loads(table.read_text("utf8")) if table.exists() else {}


def write_seconds(book: Path, store: Path, pages: Iterable[Page]) -> Path:
    """Write what each page took in its last execution, and return the table's path."""
    last = {page.docname: last_record(executions(store, page)) for page in pages}
    table = {name: round(record.seconds) for name, record in last.items() if record}
    write_whole(book / SECONDS, (json.dumps(table, indent=1) + "\n").encode())
    return book / SECONDS


def forget(store: Path, pages: Iterable[Page], into: Mapping[str, Path]) -> None:
    """Remove the pages that the book no longer has, and old folders of the others.

    Args:
        store: the folder of all executed pages.
        pages: those of the book.
        into: the folder of each; see `places`. It is kept with the newest others of its
            page.
    """
    kept: set[Path] = set()
    for page in pages:
        place = into[page.docname]
        place.touch()
        others = [path for path in folders(place.parent) if path != place]
        kept |= {place.parent, place, *others[: KEPT - 1]}
    for path in [*store.glob("*/"), *store.glob("*/*/")]:
        if path not in kept and path.exists():
            shutil.rmtree(path)
