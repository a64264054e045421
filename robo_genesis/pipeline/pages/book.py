"""The executed pages of the book and their code cells."""

import pickle
import re
from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import cast

import yaml
from myst_nb.core.read import is_myst_markdown_notebook, myst_nb_reader_plugin
from nbformat import NotebookNode
from sphinx_external_toc.parsing import MalformedError, parse_toc_yaml

from robo_genesis.core.files import NO_SOURCE, derived, files_below, json_digest
from robo_genesis.core.project import PUBLISHED, ROOT, ProjectError
from robo_genesis.pipeline.pages import page_rules as rules
from robo_genesis.pipeline.pages.syntax import PACKAGE, Code, read_code

# The name of a lesson's lab, and the file with its work sheet.
LAB, WORK_SHEET = "lab", "worksheet.md"

TOC = "_toc.yml"
CREATE = "Pages are .md files: create it, or remove its name here."
PAGES = (".md", ".markdown", ".rst", ".ipynb")
STRAY = (
    "no line of _toc.yml names this file, so no reader finds it. Add it there as a .md file, or "
    "move it out of the book or into a folder whose name begins with _."
)
TWICE = (
    "the front matter declares {}/{}, as {} does. Declare another page of the lesson."
)


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
        return next(
            (n for n, tags in enumerate(self._tags(), 1) if "alone" in tags), None
        )

    @property
    def own_kernels(self) -> bool:
        """Whether an early cell begins with a long compilation in a folder of its own."""
        return any("own-kernels" in tags for tags in self._tags())

    def _tags(self) -> list[list[str]]:
        return [cell.metadata.get("tags", []) for cell in code_cells(self.notebook)]

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
        PageError: naming file, line and cure of each problem of the book's pages.
    """
    files = page_files(book)
    own = sorted(files_below(book, (PUBLISHED, f".{PUBLISHED}"), NO_SOURCE))
    problems = [
        _report(path, [(1, STRAY)]) for path in own if _is_stray(path, book, files)
    ]
    pages: list[Page] = []
    measuring: dict[tuple[str | None, str | None], Path] = {}
    for name, path in files.items():
        try:
            notebook = _read(path, book / TOC)
        except PageError as error:
            problems.append(str(error))
            continue
        if notebook is None:
            continue
        measures = rules.declared(notebook) or (None, None)
        other = measuring.setdefault(measures, path) if measures[0] else path
        if other != path:
            line = _line_of(f"{PACKAGE}:", path)
            problems.append(_report(path, [(line, TWICE.format(*measures, other))]))
        pages.append(Page(name, path, notebook, *measures))
    if problems:
        raise PageError("\n".join(problems))
    return pages


def _read(path: Path, toc: Path) -> NotebookNode | None:
    """Return a page that has code cells; raise PageError with all that it may not contain."""
    if not path.is_file():
        line = _line_of(path.stem, toc)
        raise PageError(_report(toc, [(line, f"there is no {path}. {CREATE}")]))
    notebook = read_notebook(path)
    if problems := [*rules.page_problems(path.read_text("utf8"), notebook)]:
        raise PageError(_report(path, problems))
    return notebook


def page_files(book: Path) -> dict[str, Path]:
    """Return the file of each page by its name, in the order of the table of contents."""
    toc = book / TOC
    try:
        site_map = parse_toc_yaml(toc)
    except (OSError, ValueError, yaml.YAMLError, MalformedError) as error:
        raise PageError(
            _report(toc, [(1, f"it cannot be read: {error}\nCorrect it.")])
        ) from error
    if site_map.globs():
        raise PageError(
            f"_toc.yml uses globs {sorted(site_map.globs())}. List every page instead."
        )
    names = [str(docname).removesuffix(".md") for docname in site_map]
    return {name: book / f"{name}.md" for name in names}


def _is_stray(path: Path, book: Path, files: Mapping[str, Path]) -> bool:
    """Whether a file looks like a page, and no line of the table of contents names it."""
    hidden = any(part.startswith("_") for part in path.relative_to(book).parts)
    is_page = path.suffix.lower() in PAGES and path.name != WORK_SHEET
    return is_page and not hidden and path not in files.values()


def _line_of(word: str, path: Path) -> int:
    """Return the number of the first line of a file with a word."""
    lines = path.read_text("utf8").split("\n")
    return 1 + next((n for n, line in enumerate(lines) if word in line), 0)


def _line_of_error(error: Exception) -> int:
    """Return the line of what the reader of a page or of YAML does not accept."""
    if at := re.search(r"at line (\d+)", str(error)):
        return int(at[1])
    at = re.search(r"line (\d+), column", str(error))  # of the front matter
    return int(at[1]) + 1 if at else 1


def _report(path: Path, problems: Iterable[rules.Problem]) -> str:
    """Return a line for each problem of a file."""
    name = str(path).removeprefix(f"{ROOT}/")
    return "\n".join(f"{name}:{line}: {problem}" for line, problem in problems)


def read_notebook(path: Path) -> NotebookNode | None:
    """Return the parsed page, None if it has no code cells.

    Raises:
        PageError: it cannot be read.
    """
    try:
        text = path.read_text("utf8")
        # Parse first: MyST-NB mistakes a notebook with a broken front matter for plain
        # text.
        notebook = deepcopy(_parsed(path, text)) if text.startswith("---") else None
    except Exception as error:  # the parser raises exceptions of many types
        why = f"the page cannot be read: {error}\nFront matter and options of cells are YAML."
        raise PageError(_report(path, [(_line_of_error(error), why)])) from error
    return notebook if _is_notebook(text) else None


@lru_cache(maxsize=128)
def _is_notebook(text: str) -> bool:
    """Return whether the text of a page has code cells."""
    return bool(is_myst_markdown_notebook(text))


@lru_cache(maxsize=64)
def _parsed(path: Path, text: str) -> NotebookNode:
    """Return a page as a notebook; a build needs each page several times, in two processes."""
    read = derived(
        "parsed",
        [text.encode()],
        lambda: pickle.dumps(myst_nb_reader_plugin(str(path))),
    )
    return cast(NotebookNode, pickle.loads(read))


def code_cells(notebook: NotebookNode) -> list[NotebookNode]:
    """Return the code cells of a notebook."""
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def code_of(notebook: NotebookNode) -> Code:
    """Return what the code cells of a notebook do."""
    return read_code(cell.source for cell in code_cells(notebook))


def code_digest(page: Page) -> str:
    """Return the sha256 of the syntax of a page's code cells; text and comments do not count."""
    return json_digest(page.code.digests)
