"""Whether the engine's cache has the kernels that pages share, and which page may start then."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from robo_genesis.core.project import BACKEND, COMPILED_KERNELS
from robo_genesis.lessons.book_pages import Page


class CompiledKernels:
    """Keeps a book's pages from compiling the same kernels at the same time.

    The engine saves what it compiled when the page's kernel process ends. Pages share most of it,
    also those of different lessons: of the 46 kernels of the lab of L03, the lecture of L02 has 42.
    So while no page that runs the engine has ended with this cache, the book's first one runs
    without the others. Pages of no lesson, which do not run the engine, start in any case. The
    pages of a book with one lesson run side by side.

    An empty file beside the compiled kernels, one for each backend, says that a page has ended.
    """

    def __init__(self, pages: Sequence[Page], environment: Mapping[str, str]) -> None:
        """Read nothing yet.

        Args:
            pages: the pages to execute, in the order of the book.
            environment: the variables of their kernels. Unless they name the engine's cache, it is
                not known, and no page waits.
        """
        self.pages, kernels = pages, environment.get(COMPILED_KERNELS)
        ended = f"executed-{environment.get(BACKEND, 'any')}"
        self.ended = Path(kernels).with_name(ended) if kernels else None
        self.several = len({page.lesson for page in pages} - {None}) > 1

    def next_page(self, waiting: Sequence[Page], running: Sequence[Page]) -> Page | None:
        """Return the page that may start, None if all must wait for a running one.

        Args:
            waiting: the pages that wait, in the order in which they should start.
            running: the pages that run.
        """
        if self.several and self.ended and not self.ended.exists():
            compiling = any(page.lesson for page in running)
            first = [page for page in self.pages if page.lesson and page in waiting][:1]
            alone = [] if compiling else first
            waiting = [*alone, *(page for page in waiting if not page.lesson)]
        return waiting[0] if waiting else None

    def add(self, page: Page) -> None:
        """Note that a page was executed, so that the cache has its kernels."""
        if self.ended and page.lesson:
            self.ended.touch()
