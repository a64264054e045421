"""The cache of executed pages: a page needs no run if its outputs and its bundle are of one run."""

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partialmethod
from pathlib import Path

from jupyter_cache.base import CacheBundleIn, JupyterCacheAbstract
from jupyter_cache.cache.main import JupyterCacheBase
from nbformat import NotebookNode
from sqlalchemy.exc import OperationalError

from robo_genesis.build.page_results import (
    Failure,
    PageResult,
    Status,
    find_bundle,
    unexpected_outcome,
)
from robo_genesis.core.project import ProjectError
from robo_genesis.lessons.book_pages import Page


class PageCache(JupyterCacheBase):
    """A jupyter-cache that identifies a page by its code alone.

    The base class hashes the cells' metadata as well, so a better caption would run the engine
    again. Tags, captions and expected exceptions are read from the page, never from the cache.
    """

    create_hashed_notebook = partialmethod(
        JupyterCacheBase.create_hashed_notebook, cell_metadata=()
    )


def notebooks_folder(folder: Path) -> Path:
    """Return the jupyter-cache below the cache folder of a fingerprint."""
    return folder / "notebooks"


def outputs_folder(folder: Path) -> Path:
    """Return where pages leave their bundles, below the cache folder of a fingerprint."""
    return folder / "outputs"


@contextmanager
def usable(folder: Path) -> Iterator[None]:
    """Raise ProjectError where jupyter-cache's database in the cache folder cannot be used."""
    try:
        yield
    except (OperationalError, RuntimeError) as error:  # the database's error, bare or wrapped
        if not any(isinstance(one, OperationalError) for one in (error, error.__cause__)):
            raise
        raise ProjectError(
            f"The executed pages in {folder} cannot be kept: {error.__cause__ or error}\n"
            "Give them free space or write access, or remove that folder."
        ) from error


def store(page: Page, notebook: NotebookNode, seconds: float | None, folder: Path) -> None:
    """Keep an executed page in the cache folder of its fingerprint.

    Args:
        page: the page that was executed.
        notebook: its cells with their outputs.
        seconds: how long the execution took.
        folder: the cache folder.
    """
    executed = CacheBundleIn(
        notebook, str(page.path.absolute()), data={"execution_seconds": seconds}
    )
    cache = PageCache(notebooks_folder(folder))
    _, digest = cache.create_hashed_notebook(notebook)
    # A killed build may have left a folder without its notebook, which jupyter-cache refuses.
    shutil.rmtree(Path(cache.path) / "executed" / digest, ignore_errors=True)
    cache.cache_notebook_bundle(executed, check_validity=False, overwrite=True)


def cached_results(pages: Sequence[Page], folder: Path) -> dict[str, PageResult]:
    """Return the results of pages that need no run, by name.

    Args:
        pages: the pages of the book.
        folder: the cache folder of their fingerprint.
    """
    cache, outputs = PageCache(notebooks_folder(folder)), outputs_folder(folder)
    first: dict[str, Page] = {}
    found: dict[str, PageResult] = {}
    for page in pages:
        # The cache identifies pages by their code cells, so two equal ones overwrite each other.
        earlier = first.setdefault(cache.create_hashed_notebook(page.notebook)[1], page)
        if earlier is not page:
            message = (
                f"its code cells equal those of {earlier.docname}; the cache cannot distinguish "
                "them. Change a cell of one of the two."
            )
            failure = Failure("SameCode", message)
            found[page.docname] = PageResult(page, "failed", 0.0, "", failure=failure)
            continue
        executed = _cached_notebook(page, cache)
        run_id = executed.metadata.get("robo_genesis", {}).get("run_id") if executed else None
        bundle = find_bundle(outputs, page, run_id) if run_id and page.declares_bundle else None
        if executed is None or not run_id or (page.declares_bundle and bundle is None):
            continue
        outcome = unexpected_outcome(page.notebook, executed)
        status: Status = "failed" if outcome else "reused"
        found[page.docname] = PageResult(page, status, 0.0, run_id, bundle, outcome)
    return found


def executed_page(page: Page, folder: Path) -> NotebookNode:
    """Return the code cells of a page with their outputs.

    Args:
        page: the page.
        folder: the cache folder of its fingerprint.

    Raises:
        KeyError: the page is not executed.
    """
    cache = PageCache(notebooks_folder(folder))
    return cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk).nb


def _cached_notebook(page: Page, cache: JupyterCacheAbstract) -> NotebookNode | None:
    """Return the page's cached outputs, None if there are none or a killed build left half."""
    try:
        return cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk).nb
    except (KeyError, ValueError):
        return None
