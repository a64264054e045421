"""The store of executed pages, `<page>/<fingerprint>/`, and what goes into it from elsewhere.

Each folder holds one executed page; see `page_folder`.
"""

import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from robo_genesis.core.files import require_replaceable, require_writable
from robo_genesis.core.project import ENGINE, ROOT, ProjectError, installed_version
from robo_genesis.pipeline.pages import folder
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.results import (
    PageResult,
    find_bundle,
    unexpected_outcome,
)
from robo_genesis.pipeline.pages.sources import (
    Tree,
    page_fingerprint,
    require_keyed_imports,
)

# Takes a bundle's folder and its run id; returns the manifest or raises BundleRefused.
Verify = Callable[[Path, str], Any]

KEPT = 3  # Folders that are kept of each page; RENDER=0 and RENDER=1 have one each
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
        place: the page's folder. A link or a file in its place is removed.

    Raises:
        PageRefused: the folder is there, but it is not this page.
    """
    if place.is_symlink() or not place.is_dir():
        place.unlink(missing_ok=True)
        return None
    return result_of(page, place, place.name)


def result_of(page: Page, place: Path, fingerprint: str) -> PageResult:
    """Return the result of a page from a folder that holds it as this checkout executes it.

    Raises:
        PageRefused: the folder is not this page, or its outputs contradict the tags and
            expected exceptions of the page.
    """
    record = folder.read_record(place)
    notebook = folder.require_this_page(place, record, page, fingerprint)
    if outcome := unexpected_outcome(page, notebook):
        raise folder.PageRefused("outcome", f"{outcome.error}: {outcome.message}")
    bundle = find_bundle(place / folder.OUTPUTS, record.run_id)
    return PageResult(page, "reused", 0.0, record.run_id, bundle, folder=place)


def folders(store: Path, page: Page) -> list[Path]:
    """Return the folders that the store has of a page, the newest first."""
    found = (store / _folder(page)).glob("[!.]*/")
    return sorted(found, key=lambda path: path.stat().st_mtime, reverse=True)


def last_record(store: Path, page: Page) -> folder.Record | None:
    """Return the record of the last stored execution of a page, None if there was none."""
    with suppress(folder.PageRefused, IndexError):
        return folder.read_record(folders(store, page)[0])
    return None


def failed_mark(place: Path) -> Path:
    """Return the file that says that a page's last run with this engine failed or was refused.

    Args:
        place: the page's folder, where a failed page is absent.
    """
    return place.with_name(f"failed-{installed_version(ENGINE)}")


def forget(store: Path, pages: Iterable[Page], into: Mapping[str, Path]) -> None:
    """Remove the pages that the book no longer has, and old folders of the others.

    Args:
        store: the folder of all executed pages.
        pages: those of the book.
        into: the folder of each; see `places`. It is kept with the newest others of its
            page, even if these have times in the future.
    """
    kept: set[Path] = set()
    for page in pages:
        place = into[page.docname]
        place.touch()
        others = [path for path in folders(store, page) if path != place]
        kept |= {place.parent, place, *others[: KEPT - 1]}
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
    require_replaceable(place, folder.RECORD)
    return place


def handed_over(
    source: Path, pages: Sequence[Page], into: Mapping[str, Path]
) -> list[PageResult]:
    """Return the results of pages that another machine executed, in the order of `pages`.

    All of them are compared with this checkout. The names and paths that they state are
    compared, never followed. Nothing is stored: their bundles and outputs are not
    verified yet.

    Args:
        source: holds the folders of `exported`, at any depth.
        pages: the pages of the book.
        into: where the store would have each page; see `places`.

    Raises:
        ProjectError: it names each page that is missing, or each refused one with code
            and reason.
    """
    if not source.is_dir():
        raise ProjectError(
            f"EXECUTED={source} is not a folder. Name the one that `make execute TO=folder` filled."
        )
    known = {page.docname: page for page in pages}
    found: dict[str, PageResult] = {}
    problems = []
    for place in exported_folders(source):
        try:
            name = folder.read_record(place).docname
            if name not in known:
                valid = f"Pages of this book: {', '.join(known)}."
                raise folder.PageRefused("page", f"its page is {name!r}. {valid}")
            result = result_of(known[name], place, into[name].name)
            if name in found:
                other = found[name].folder
                raise folder.PageRefused(
                    "twice", f"{name} is in {other} as well. Remove one."
                )
            found[name] = replace(result, status="taken over")
        except folder.PageRefused as error:
            problems.append(f"{place}: {error}")
    if not problems:  # a refused page would be reported as missing as well
        problems = [f"{name} is not among them." for name in known if name not in found]
    if problems:
        first = f"The executed pages in {source} are refused."
        raise ProjectError("\n".join([first, *problems, AGAIN]))
    return [found[name] for name in known]


def exported_folders(source: Path) -> list[Path]:
    """Return the folders that hold a record, except hidden ones and those within another."""
    found: list[Path] = []
    for path in sorted(source.rglob(folder.RECORD), key=lambda path: len(path.parts)):
        hidden = any(part.startswith(".") for part in path.relative_to(source).parts)
        if not hidden and not any(place in path.parents for place in found):
            found.append(path.parent)
    return sorted(found)
