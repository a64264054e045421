"""Publish a rendered site in one move: built beside the old one, swapped in by renames."""

import os
import shutil
from collections.abc import Iterable
from pathlib import Path

from robo_genesis.page_results import PageResult

PUBLISHED, NEXT, OLD = "_build", "_build.next", "_build.old"
PAGES = "pages"
"""Beside `evidence`: the bundles of pages that are no lab, which a refresh compares as well."""


def recover(book: Path) -> None:
    """Bring a book's published folder into order after a build that was killed.

    Killed between the two renames, the old site stands aside: it comes back. Killed later, it is
    only rubbish, as is a next site that was never swapped in.

    Args:
        book: the folder that holds `_build`.
    """
    published, aside = book / PUBLISHED, book / OLD
    if aside.exists() and not published.exists():
        aside.rename(published)
    for folder in (aside, book / NEXT):
        if folder.exists():
            shutil.rmtree(folder)


def publish(book: Path, html: Path, results: Iterable[PageResult]) -> Path:
    """Put a rendered site and its pages' bundles in the place of the old ones.

    Args:
        book: the folder that holds `_build`.
        html: the rendered and checked site; it is moved away.
        results: the executed pages; bundles of pages named `lab` become
            `evidence/<lesson>/<backend>`, others `pages/<lesson>/<page>/<backend>`.

    Returns:
        The folder of the published site's HTML.

    Raises:
        OSError: nothing is changed, the old site stands.
    """
    recover(book)
    following = book / NEXT
    try:
        following.mkdir()
        shutil.move(html, following / "html")
        for result in results:
            if result.bundle is not None:
                lesson, page = str(result.page.lesson), str(result.page.page)
                own = ("evidence", lesson) if page == "lab" else (PAGES, lesson, page)
                shutil.copytree(result.bundle, following.joinpath(*own, result.bundle.name))
        _swap(book)
    finally:
        recover(book)
    return book / PUBLISHED / "html"


def _swap(book: Path) -> None:
    """Exchange the published folder; `recover` mends what a kill between the renames leaves."""
    if (book / PUBLISHED).exists():
        os.rename(book / PUBLISHED, book / OLD)
    os.rename(book / NEXT, book / PUBLISHED)
