"""The executed pages of the book and their code cells."""

import pickle
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import cast

import yaml
from myst_nb.core.read import is_myst_markdown_notebook, myst_nb_reader_plugin
from nbformat import NotebookNode
from sphinx_external_toc.parsing import MalformedError, parse_toc_yaml

from robo_genesis.core.files import derived, json_digest
from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.pages.syntax import PACKAGE, Code, read_code


class PageError(ProjectError):
    """A page or the table of contents cannot be read, or is not valid."""


@dataclass(frozen=True, slots=True)
class Page:
    """One page whose code cells are executed.

    `lesson` and `page` come from the front matter's `robo_genesis: {lesson, page}`: such a page
    runs the engine and must leave an evidence bundle. Both are None on other pages.
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
        return next((n for n, tags in enumerate(self._tags(), 1) if "alone" in tags), None)

    @property
    def own_kernels(self) -> bool:
        """Whether an early cell begins with a long compilation in a folder of its own."""
        return any("own-kernels" in tags for tags in self._tags())

    def _tags(self) -> list[list[str]]:
        cells = (cell for cell in self.notebook.cells if cell.cell_type == "code")
        return [cell.metadata.get("tags", []) for cell in cells]

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
        PageError: `_toc.yml` or pages cannot be read, a named file is missing, or a front matter
            is incomplete or not allowed; the message names every such page.
    """
    pages: list[Page] = []
    problems: list[str] = []
    for docname in docnames(book / "_toc.yml"):
        try:
            pages += _read(book, docname)
        except PageError as error:
            problems.append(str(error))
    if problems:
        raise PageError("\n".join(problems))
    return pages


def docnames(toc: Path) -> list[str]:
    """Return the names of all pages in the order of the table of contents."""
    try:
        site_map = parse_toc_yaml(toc)
    except (OSError, ValueError, yaml.YAMLError, MalformedError) as error:
        raise PageError(
            f"The table of contents {toc} cannot be read: {error}\nCorrect that file."
        ) from error
    if site_map.globs():
        raise PageError(f"_toc.yml uses globs {sorted(site_map.globs())}. List every page instead.")
    return [str(docname) for docname in site_map]


def _read(book: Path, docname: str) -> Iterator[Page]:
    """Yield the page if it is executed."""
    name = docname.removesuffix(".md")
    path = (book / name).with_name(Path(name).name + ".md")
    if not path.is_file():
        raise PageError(f"_toc.yml names {docname!r}, but there is no {path}. Pages are .md files.")
    notebook = read_notebook(path, name)
    if notebook is None:
        return
    if "name" not in notebook.metadata.get("kernelspec", {}):
        raise PageError(f"{name}: front matter needs `kernelspec: {{name: python3}}`.")
    if notebook.metadata.get("execution", {}).get("allow_errors"):
        raise PageError(
            f"{name}: `execution: allow_errors` would publish failing cells. Tag the one cell "
            "`raises-exception`, and name the exception with `expects`."
        )
    yield Page(name, path, notebook, *_declared(name, notebook))


def read_notebook(path: Path, name: str = "") -> NotebookNode | None:
    """Return the parsed page, None if it has no code cells.

    Args:
        path: of the page.
        name: of the page in messages.

    Raises:
        PageError: it cannot be read.
    """
    try:
        text = path.read_text("utf8")
        # Parse first: MyST-NB mistakes a notebook with a broken front matter for plain text.
        notebook = deepcopy(_parsed(path, text)) if text.startswith("---") else None
    except Exception as error:  # the parser raises exceptions of many types
        raise PageError(
            f"{name}: the page cannot be read: {error}\nCorrect {path}. Front matter and the "
            "options of cells (`:name: value`) are YAML."
        ) from error
    return notebook if _is_notebook(text) else None


@lru_cache(maxsize=128)
def _is_notebook(text: str) -> bool:
    """Return whether the text of a page has code cells."""
    return bool(is_myst_markdown_notebook(text))


@lru_cache(maxsize=64)
def _parsed(path: Path, text: str) -> NotebookNode:
    """Return a page as a notebook; a build needs each page several times, in two processes."""
    read = derived(
        "parsed", [text.encode()], lambda: pickle.dumps(myst_nb_reader_plugin(str(path)))
    )
    return cast(NotebookNode, pickle.loads(read))


def _declared(name: str, notebook: NotebookNode) -> tuple[str | None, str | None]:
    """Return lesson and page from the front matter; both are None without a declaration."""
    declared = notebook.metadata.get(PACKAGE)
    if declared is None:
        return None, None
    given = dict(declared) if isinstance(declared, dict) else {}
    parts = [given.get(key) for key in ("lesson", "page")]
    words = all(isinstance(part, str) and part.isidentifier() for part in parts)
    if not words or given.keys() - {"lesson", "page"}:
        raise PageError(
            f"{name}: front matter has `{PACKAGE}: {declared!r}`. "
            f"Valid is `{PACKAGE}: {{lesson: l04, page: lab}}`, both plain words."
        )
    return parts[0], parts[1]


def code_of(notebook: NotebookNode) -> Code:
    """Return what the code cells of a notebook do."""
    return read_code(cell.source for cell in notebook.cells if cell.cell_type == "code")


def code_digest(page: Page) -> str:
    """Return the sha256 of the syntax of a page's code cells; text and comments do not count."""
    return json_digest(page.code.digests)
