"""The first stage of `make book` by itself: execute one page and hand it over as files."""

from collections.abc import Sequence
from pathlib import Path

from robo_genesis.build.page_export import hand_over
from robo_genesis.build.stages import Build, BuildError, Progress, execute_stage, only_build
from robo_genesis.core import project
from robo_genesis.evidence.bundle_store import require_folder
from robo_genesis.lessons.book_pages import Page, find_pages, fingerprint


def execute_one(asked: str, to: Path | None, build: Build) -> list[str]:
    """Execute one page of the book, unless the cache holds it, and hand it over.

    Args:
        asked: the page as the table of contents names it, or as `l04/lab`.
        to: gets the page's folder.
        build: where book and caches are, and with which resources.

    Returns:
        The last lines for the user: where the page is, and what executed it.

    Raises:
        BuildError: there is no such page, it failed, or a build runs here. Nothing was handed over.
        HandoverError, ProjectError, PageError: folder, checkout or book are not fit for it.
    """
    with only_build(build.cache):
        pages = find_pages(build.book)
        page = asked_page(asked, pages)
        if to is None:
            raise BuildError("TO is not set. Name the folder that gets the page: TO=folder.")
        require_folder(to)
        engine = project.require_pinned_engine(build.root)
        project.remove_stale_kernel_lock(build.cache)
        folder = project.page_cache_folder(fingerprint(pages, build.root), build.cache)
        progress = Progress(build.say)
        [result] = execute_stage(build, [page], folder, progress)
        place = hand_over(result, folder, to)
        progress("handover", page.docname, result.status)
    return [f"Executed page: {place}", f"Engine: {project.ENGINE} {engine}, run {result.run_id}"]


def asked_page(asked: str, pages: Sequence[Page]) -> Page:
    """Return the page that PAGE names.

    Raises:
        BuildError: there is none; the message lists those that there are.
    """
    names = {page.docname: page for page in pages}
    names |= {f"{page.lesson}/{page.page}": page for page in pages if page.declares_bundle}
    if asked not in names:
        valid = ", ".join(page.docname for page in pages) or "none"
        raise BuildError(f"PAGE={asked!r} is not valid. Executed pages of this book: {valid}.")
    return names[asked]
