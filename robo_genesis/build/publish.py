"""Publish a rendered site in one move: built beside the old one, swapped in by renames."""

import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # `make verify` asks only for names, and need not load Jupyter for them
    from robo_genesis.build.page_results import PageResult

from robo_genesis.core.files import NEXT, beside, settle, swap
from robo_genesis.core.project import PUBLISHED

PAGES = "pages"
"""Beside `evidence`: the bundles of pages that are no lab, which a refresh compares as well."""


def recover(book: Path) -> None:
    """Bring a book's published folder into order after a build that was killed; see `settle`.

    Args:
        book: the folder that holds `_build`.
    """
    settle(book / PUBLISHED)


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
