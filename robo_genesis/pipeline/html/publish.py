"""Publish a rendered site in one move: built beside the old one, swapped in by renames."""

import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from robo_genesis.core.files import replaced
from robo_genesis.core.project import PUBLISHED, STAGING
from robo_genesis.pipeline.html.draft import Draft

if TYPE_CHECKING:  # commands that need only names load no Jupyter
    from robo_genesis.pipeline.pages.results import PageResult

PAGES = (
    "pages"  # The folder beside `evidence` with the bundles of other pages than labs
)


def add_bundles(draft: Draft, results: Iterable["PageResult"]) -> None:
    """Copy the bundles of executed pages into a draft.

    Args:
        draft: bundles of pages named `lab` become `evidence/<lesson>/<backend>` in its
            folder, others `pages/<lesson>/<page>/<backend>`.
        results: the executed pages.

    Raises:
        OSError: a bundle cannot be read.
    """
    for result in results:
        if result.bundle is not None:
            lesson, page = str(result.page.lesson), str(result.page.page)
            own = ("evidence", lesson) if page == "lab" else (PAGES, lesson, page)
            shutil.copytree(
                result.bundle, draft.folder.joinpath(*own, result.bundle.name)
            )


def publish(
    book: Path, folder: Path, finish: Callable[[Path], None] = lambda folder: None
) -> Path:
    """Replace the published site and its pages' bundles by new ones, which everybody may read.

    A web server has a user of its own, so the modes do not depend on the umask.

    Args:
        book: the folder that holds `_build`.
        folder: the site, rendered and checked, and the bundles; it is moved away.
        finish: called with the complete folder before it is put in place.

    Returns:
        The folder of the published site's HTML.

    Raises:
        OSError: nothing is changed.
    """
    with replaced(book / PUBLISHED) as following:
        shutil.move(folder, following)
        finish(following)
        for here, _, files in os.walk(following):
            os.chmod(here, 0o755)
            for name in files:
                os.chmod(os.path.join(here, name), 0o644)
    return book / PUBLISHED / "html"


@contextmanager
def staging_folder(cache: Path) -> Iterator[Path]:
    """Make the folder in which one build renders; remove it in the end.

    The build lock must be held: folders of killed builds are removed first. A process
        that a killed
    build left would write into its own folder and not into this one.

    Args:
        cache: folder of the caches.
    """
    for left in cache.glob(f"{STAGING}*"):
        shutil.rmtree(left, ignore_errors=True)
    with tempfile.TemporaryDirectory(
        prefix=f"{STAGING}-", dir=cache, ignore_cleanup_errors=True
    ) as own:
        yield Path(own)
