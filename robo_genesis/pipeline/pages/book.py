"""The executed pages of the book and their code cells."""

import pickle
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import yaml
from myst_nb.core.read import is_myst_markdown_notebook, myst_nb_reader_plugin
from nbformat import NotebookNode
from sphinx_external_toc.parsing import MalformedError, parse_toc_yaml

from robo_genesis.core.files import derived, json_digest
from robo_genesis.core.project import ROOT, ProjectError

from .page_rules import declared, page_problems, text_problems
from .syntax import Code, read_code

# The name of a lesson's lab, and the file with its work sheet.
LAB, WORK_SHEET = "lab", "worksheet.md"

TOC = "_toc.yml"


class PageError(ProjectError):
    """A page or the table of contents cannot be read, or is not valid."""


@dataclass(frozen=True, slots=True)
class Page:
    """One page whose code cells are executed.

    `lesson` and `page` come from the front matter's `robo_genesis: {lesson, page}`:
    such a page runs the engine and must leave an evidence bundle. Both are None on
    other pages.
    """

    docname: str
    path: Path
    notebook: NotebookNode
    lesson: str | None = None
    page: str | None = None

    @property
    def declares_bundle(self) -> bool:
        """Whether the page must leave an evidence bundle."""
        return self.lesson is not None

    @property
    def alone(self) -> int | None:
        """The number of its first code cell tagged `alone`, counted from 1; None if none is.

        From there on it measures time: no other page is executed meanwhile.
        """
        return next(self._tagged("alone"), None)

    @property
    def compiles_first(self) -> int:
        """The number of its last code cell tagged `compiles-first`; 0 if none is.

        Where no kernel is compiled yet, no other page starts before the end of this
        cell.
        """
        return max(self._tagged("compiles-first"), default=0)

    def _tagged(self, tag: str) -> Iterator[int]:
        """Yield the numbers of the code cells with a tag."""
        for number, cell in enumerate(code_cells(self.notebook), start=1):
            if tag in cell.metadata.get("tags", []):
                yield number

    @property
    def code(self) -> Code:
        """What its code cells do."""
        return code_of(self.notebook)


def find_pages(book: Path) -> list[Page]:
    """Return the executed pages of a book, in the order of its table of contents.

    Args:
        book: the folder with `_toc.yml`.

    Returns:
        The MyST text notebooks among the pages that the table of contents names.

    Raises:
        PageError: naming file, line and cure of each problem of the book's pages and
            work sheets.
    """
    pages: list[Page] = []
    problems: list[str] = []
    measuring: dict[tuple[str, str], Path] = {}
    sheets = {path.as_posix(): path for path in book.glob(f"*/*/{WORK_SHEET}")}
    for name, path in (page_files(book) | sheets).items():
        try:
            notebook = read_notebook(path)
        except PageError as error:
            problems.append(str(error))
            continue
        found = [*text_problems(path)]
        if notebook:
            found += page_problems(notebook)
            if measures := declared(notebook):
                other = measuring.setdefault(measures, path)
                if other != path:
                    found.append(
                        (1, f"it declares the lesson and page that {other} declares.")
                    )
            pages.append(Page(name, path, notebook, *(measures or ())))
        problems += [f"{path}:{line}: {problem}" for line, problem in found]
    if problems:
        raise PageError("\n".join(problems).replace(f"{ROOT}/", ""))
    return pages


def page_files(book: Path) -> dict[str, Path]:
    """Return the file of each page by its name, in the order of the table of contents."""
    try:
        names = [str(name).removesuffix(".md") for name in parse_toc_yaml(book / TOC)]
    except (OSError, ValueError, yaml.YAMLError, MalformedError) as error:
        raise PageError(f"{book / TOC} cannot be read: {error}") from error
    return {name: book / f"{name}.md" for name in names}


def read_notebook(path: Path) -> NotebookNode | None:
    """Return the parsed page, None if it has no code cells.

    Raises:
        PageError: it cannot be read.
    """

    def parse() -> bytes:
        # Parse first: MyST-NB takes a notebook with a broken front matter for plain text.
        notebook = myst_nb_reader_plugin(str(path)) if text.startswith("---") else None
        return pickle.dumps(notebook if is_myst_markdown_notebook(text) else None)

    try:
        text = path.read_text("utf8")
        return pickle.loads(derived("parsed", [text.encode()], parse))
    except Exception as error:  # the parser raises exceptions of many types
        raise PageError(
            f"{path} cannot be read: {error}\nFront matter and options of cells are YAML."
        ) from error


def code_cells(notebook: NotebookNode) -> list[NotebookNode]:
    """Return the code cells of a notebook."""
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def code_of(notebook: NotebookNode) -> Code:
    """Return what the code cells of a notebook do."""
    return read_code(cell.source for cell in code_cells(notebook))


def code_digest(page: Page) -> str:
    """Return the sha256 of the syntax of a page's code cells; text and comments do not count."""
    return json_digest(page.code.digests)
