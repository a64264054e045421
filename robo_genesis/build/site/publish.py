"""Publish a rendered site in one move: built beside the old one, swapped in by renames."""

import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from robo_genesis.core.files import replaced
from robo_genesis.core.project import PUBLISHED

if TYPE_CHECKING:  # commands that need only names load no Jupyter
    from robo_genesis.build.page_results import PageResult

PAGES = "pages"
"""The folder beside `evidence` with the bundles of other pages than labs."""


def publish(
    book: Path,
    html: Path,
    results: Iterable["PageResult"],
    finish: Callable[[Path], None] = lambda folder: None,
) -> Path:
    """Replace the published site and its pages' bundles by new ones.

    Args:
        book: the folder that holds `_build`.
        html: the rendered and checked site; it is moved away.
        results: the executed pages; bundles of pages named `lab` become
            `evidence/<lesson>/<backend>`, others `pages/<lesson>/<page>/<backend>`.
        finish: called with the complete folder before it is put in place.

    Returns:
        The folder of the published site's HTML.

    Raises:
        OSError: nothing is changed.
    """
    with replaced(book / PUBLISHED) as following:
        following.mkdir()
        shutil.move(html, following / "html")
        for result in results:
            if result.bundle is not None:
                lesson, page = str(result.page.lesson), str(result.page.page)
                own = ("evidence", lesson) if page == "lab" else (PAGES, lesson, page)
                shutil.copytree(result.bundle, following.joinpath(*own, result.bundle.name))
        finish(following)
    return book / PUBLISHED / "html"
