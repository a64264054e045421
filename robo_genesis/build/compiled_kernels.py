"""Which lessons' kernels the engine's cache has, and which page may start for that reason."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from robo_genesis.core.project import BACKEND, COMPILED_KERNELS
from robo_genesis.lessons.book_pages import Page


class CompiledKernels:
    """Keeps a book's pages from compiling the same kernels twice.

    The engine saves what it compiled when the page's kernel process ends. The pages of a lesson
    share most of it. So while no page of a lesson has ended with this cache, one page of it runs at
    a time, and pages of other lessons run meanwhile. In a book with one lesson there are none, and
    its pages run side by side.

    A file for each lesson and backend, beside the compiled kernels, says that a page has ended.
    """

    def __init__(self, pages: Iterable[Page], environment: Mapping[str, str]) -> None:
        """Read nothing yet.

        Args:
            pages: the pages to execute.
            environment: the variables of their kernels. Unless they name the engine's cache, it is
                not known, and the pages start in any case.
        """
        kernels = environment.get(COMPILED_KERNELS)
        self.folder = Path(kernels).with_name("lessons") if kernels else None
        self.backend = environment.get(BACKEND, "any")
        self.several = len({page.lesson for page in pages} - {None}) > 1

    def next_page(self, waiting: Sequence[Page], running: Iterable[Page]) -> Page | None:
        """Return the first page that may start, None if all must wait for a running one.

        Args:
            waiting: the pages that wait, in the order in which they should start.
            running: the pages that run.
        """
        compiling = {page.lesson for page in running if self._compiles(page)}
        return next((page for page in waiting if page.lesson not in compiling), None)

    def add(self, page: Page) -> None:
        """Note that a page was executed, so that the cache has its kernels."""
        if self.folder and page.lesson:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._mark(self.folder, page).touch()

    def _compiles(self, page: Page) -> bool:
        """Return whether a running page compiles kernels that other pages need."""
        if not (self.several and self.folder and page.lesson):
            return False
        return not self._mark(self.folder, page).exists()

    def _mark(self, folder: Path, page: Page) -> Path:
        return folder / f"{page.lesson}-{self.backend}"
