"""Which pages need no run: cached outputs and a bundle that belong to one run."""

import hashlib
import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from jupyter_cache.base import JupyterCacheAbstract
from jupyter_cache.cache.db import NbCacheRecord
from jupyter_cache.cache.main import JupyterCacheBase
from nbformat import NotebookNode
from sqlalchemy.exc import OperationalError

from robo_genesis.build.page_results import Failure, PageResult, find_bundle, unexpected_outcome
from robo_genesis.core.project import ProjectError
from robo_genesis.lessons.book_pages import Page


class PageCache(JupyterCacheBase):
    """A jupyter-cache that knows a page by its code alone.

    The base class counts the cells' metadata, too: a better caption would run the engine again.
    What metadata decide (exceptions, captions, tags) is read from the page, never from the cache.
    """

    def create_hashed_notebook(
        self,
        nb: NotebookNode,
        nb_metadata: Iterable[str] | None = ("kernelspec",),
        cell_metadata: Iterable[str] | None = (),
    ) -> tuple[NotebookNode, str]:
        """Return the notebook's code cells and their digest; see the base class."""
        hashed: tuple[NotebookNode, str] = super().create_hashed_notebook(
            nb, nb_metadata, cell_metadata
        )
        return hashed


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


def array_digests(outputs: Path) -> dict[str, str]:
    """Return each archive of arrays that pages recorded, by its name below `outputs`, → its sha256.

    The archives hold no time and no run id: the same numbers make the same bytes.
    """
    return {
        path.relative_to(outputs).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(outputs.glob("*/*/*/arrays/*.npz"))
    }


def cached_results(
    pages: Sequence[Page], cache: JupyterCacheAbstract, outputs: Path
) -> dict[str, PageResult]:
    """Return the results of pages that need no run; remove what is cached of all others.

    Args:
        pages: the pages of the book.
        cache: the jupyter-cache of their fingerprint.
        outputs: where their bundles are.
    """
    found = _twins(pages, cache)
    for page in [page for page in pages if page.docname not in found]:
        executed = _cached_notebook(page, cache)
        run_id = executed.metadata.get("robo_genesis", {}).get("run_id") if executed else None
        bundle = find_bundle(outputs, page, run_id) if run_id and page.declares_bundle else None
        if executed is None or not run_id or (page.declares_bundle and bundle is None):
            _forget(page, cache)
            continue
        failure = unexpected_outcome(page.notebook, executed)
        found[page.docname] = (
            _failed(page, failure, run_id)
            if failure
            else PageResult(page, "reused", 0.0, run_id, bundle)
        )
    return found


def _cached_notebook(page: Page, cache: JupyterCacheAbstract) -> NotebookNode | None:
    """Return the page's cached outputs, None if there are none or a killed build left half."""
    try:
        return cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk).nb
    except (KeyError, ValueError):
        return None


def _forget(page: Page, cache: Any) -> None:
    """Remove what the cache holds of a page, whole or half."""
    _, digest = cache.create_hashed_notebook(page.notebook)
    shutil.rmtree(Path(cache.path) / "executed" / digest, ignore_errors=True)
    try:
        record = NbCacheRecord.record_from_hashkey(digest, cache.db)
    except KeyError:
        return
    NbCacheRecord.remove_record(record.pk, cache.db)


def _twins(pages: Sequence[Page], cache: JupyterCacheAbstract) -> dict[str, PageResult]:
    """Return a failure for each page whose code cells equal an earlier page's.

    jupyter-cache knows pages by their code cells alone: the two would overwrite each other.
    """
    first: dict[str, Page] = {}
    failed: dict[str, PageResult] = {}
    for page in pages:
        _, digest = cache.create_hashed_notebook(page.notebook)
        earlier = first.setdefault(digest, page)
        if earlier is not page:
            message = (
                f"its code cells are those of {earlier.docname}; the cache cannot tell them apart."
            )
            failed[page.docname] = _failed(page, Failure("SameCode", message))
    return failed


def _failed(page: Page, failure: Failure, run_id: str = "") -> PageResult:
    return PageResult(page, "failed", 0.0, run_id, failure=failure)
