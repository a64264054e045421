"""The executed pages of this build, as the build tells them to Sphinx's process."""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Self

from nbformat import NotebookNode
from pydantic import Field

from robo_genesis.core.project import BUILD_BACKEND, EXECUTED_PAGES
from robo_genesis.evidence.bundle import Strict
from robo_genesis.lessons import find_page

from .book import code_cells
from .page_folder import OUTPUTS, SECONDS, executed_cells
from .results import PageResult

# A variable: if it is set, a page whose code changed is shown with the outputs of its
# last run.
LAST_OUTPUTS = "ROBO_GENESIS_LAST_OUTPUTS"


class PageIndex(Strict):
    """A file that the environment names.

    `folders` has the folder in the store of each executed page by name, and `outputs`
    the files that the run of each measuring page left, by `lesson/page`.
    """

    folders: dict[str, Path] = Field(default_factory=dict)
    outputs: dict[str, Path] = Field(default_factory=dict)

    @classmethod
    def of(cls, results: Iterable[PageResult]) -> Self:
        """Return the pages of a build from their results, of which none failed."""
        found = cls()
        for result in results:
            page, folder = result.page, result.folder
            found.folders[page.docname] = folder
            if page.declares_bundle:
                found.outputs[f"{page.lesson}/{page.page}"] = folder / OUTPUTS
        return found

    def write(self, path: Path) -> dict[str, str]:
        """Write the file and return the variable that names it."""
        path.write_text(self.model_dump_json(indent=1), "utf8")
        return {EXECUTED_PAGES: str(path)}


def page_index() -> PageIndex:
    """Return the pages that the environment names."""
    return PageIndex.model_validate_json(Path(os.environ[EXECUTED_PAGES]).read_bytes())


def executed_notebook(docname: str, page: NotebookNode) -> NotebookNode:
    """Return the code cells of a page with their outputs.

    Args:
        docname: the name of the page.
        page: the page as a notebook. Its code cells differ from those of the run only
            if it is shown with the outputs of its last run.

    Raises:
        KeyError: the page is not executed.
    """
    executed = executed_cells(page_index().folders[docname])
    if LAST_OUTPUTS in os.environ:
        executed.cells = with_last_outputs(code_cells(page), executed.cells)
    return executed


def with_last_outputs(
    cells: Sequence[NotebookNode], ran: Sequence[NotebookNode]
) -> list[NotebookNode]:
    """Return code cells with the outputs of a run of other cells.

    A cell gets the outputs of the cell with equal source. If there are as many cells, a
    changed one gets those of the cell in its place. Others get none.

    Args:
        cells: of the page now.
        ran: the cells of the run.
    """
    by_source = {cell.source: cell for cell in ran}
    none = NotebookNode(outputs=[], execution_count=None)
    found = []
    for number, cell in enumerate(cells):
        there = ran[number] if len(ran) == len(cells) else none
        old = by_source.get(cell.source, there)
        found.append(NotebookNode(cell | {name: old[name] for name in none}))
    return found


def cell_seconds(docname: str) -> list[float]:
    """Return how long each cell with code of an executed page took.

    Raises:
        LookupError: the page is not executed.
    """
    folder = page_index().folders.get(docname)
    if folder is None:
        raise LookupError(f"{docname} is not executed. Build with `make book`.")
    return executed_cells(folder).metadata[SECONDS]


def measuring_page(docname: str) -> str:
    """Return the lesson and page of an executed page: `l04/lab`.

    Raises:
        LookupError: the page leaves no bundle.
    """
    pages, folder = page_index(), page_index().folders.get(docname)
    for name, left in pages.outputs.items():
        if folder in left.parents:
            return name
    raise LookupError(
        f"{docname} measures nothing. Name another page first: `l04/lab near_coulomb`."
    )


def page_bundle(lesson_page: str) -> Path:
    """Return the folder of the bundle that a page's run of this build left.

    Args:
        lesson_page: `l04/lab`. If this build has no run of the page, the folder does not
            exist.

    Raises:
        LookupError: no lesson has such a page; the message lists the choices.
    """
    outputs = page_index().outputs
    absent = Path(os.environ[EXECUTED_PAGES]).with_name("not executed") / lesson_page
    if lesson_page not in outputs:
        lesson, _, page = lesson_page.partition("/")
        find_page(lesson, page)
    return outputs.get(lesson_page, absent) / BUILD_BACKEND
