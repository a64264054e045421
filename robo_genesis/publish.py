"""Publish a rendered site in one move: built beside the old one, swapped in by renames."""

import os
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # `make verify` asks only for names, and need not load Jupyter for them
    from robo_genesis.page_results import PageResult

PUBLISHED, NEXT, OLD = "_build", ".next", ".old"
PAGES = "pages"
"""Beside `evidence`: the bundles of pages that are no lab, which a refresh compares as well."""


def recover(book: Path) -> None:
    """Bring a book's published folder into order after a build that was killed; see `settle`.

    Args:
        book: the folder that holds `_build`.
    """
    settle(book / PUBLISHED)


def settle(folder: Path, prefix: str = "") -> None:
    """Bring a folder that is swapped in whole into order, after a kill at any point.

    Killed between the two renames, the old folder lies aside: it comes back. Killed later, it is
    only rubbish, as is a next one that was never swapped in.

    Args:
        folder: what `swap` exchanges; it need not exist.
        prefix: see `beside`.
    """
    aside = beside(folder, OLD, prefix)
    if aside.exists() and not folder.exists():
        aside.rename(folder)
    for other in (aside, beside(folder, NEXT, prefix)):
        if other.exists():
            shutil.rmtree(other)


def swap(folder: Path, prefix: str = "") -> None:
    """Put the complete next folder, which lies beside, in the place of a folder.

    Args:
        folder: `settle` repairs what a kill between the two renames leaves, and removes the old
            one.
        prefix: see `beside`.
    """
    if folder.exists():
        os.rename(folder, beside(folder, OLD, prefix))
    os.rename(beside(folder, NEXT, prefix), folder)


def beside(folder: Path, suffix: str, prefix: str = "") -> Path:
    """Return where the next or the old state of a folder lies; a prefix `.` hides it there."""
    return folder.with_name(f"{prefix}{folder.name}{suffix}")


def publish(
    book: Path,
    html: Path,
    results: Iterable["PageResult"],
    finish: Callable[[Path], None] = lambda folder: None,
) -> Path:
    """Put a rendered site and its pages' bundles in the place of the old ones.

    Args:
        book: the folder that holds `_build`.
        html: the rendered and checked site; it is moved away.
        results: the executed pages; bundles of pages named `lab` become
            `evidence/<lesson>/<backend>`, others `pages/<lesson>/<page>/<backend>`.
        finish: called with the complete folder before it is put in place.

    Returns:
        The folder of the published site's HTML.

    Raises:
        OSError: nothing is changed, the old site stands.
    """
    recover(book)
    following = beside(book / PUBLISHED, NEXT)
    try:
        following.mkdir()
        shutil.move(html, following / "html")
        for result in results:
            if result.bundle is not None:
                lesson, page = str(result.page.lesson), str(result.page.page)
                own = ("evidence", lesson) if page == "lab" else (PAGES, lesson, page)
                shutil.copytree(result.bundle, following.joinpath(*own, result.bundle.name))
        finish(following)
        swap(book / PUBLISHED)
    finally:
        recover(book)
    return book / PUBLISHED / "html"
