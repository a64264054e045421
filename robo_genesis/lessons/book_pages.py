"""Which pages are executed, which modules they import, and the fingerprint of both."""

import ast
import hashlib
import json
import platform
from collections.abc import Iterable, Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import yaml
from IPython.core.inputtransformer2 import TransformerManager
from myst_nb.core.read import is_myst_markdown_notebook, myst_nb_reader_plugin
from nbformat import NotebookNode
from sphinx_external_toc.parsing import MalformedError, parse_toc_yaml

from robo_genesis.core.project import (
    ROOT,
    ProjectError,
    environment_contract,
    installed_packages,
    lock_digest,
)

PACKAGE = "robo_genesis"
DATA_SUFFIXES = (".json", ".toml", ".yaml", ".yml", ".csv")


class PageError(ProjectError):
    """A page or the table of contents is written in a way that the build cannot use."""


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
            f"The table of contents {toc} cannot be read: {error}\nMend it there."
        ) from error
    if site_map.globs():
        raise PageError(f"_toc.yml uses globs {sorted(site_map.globs())}; name every page instead.")
    return [str(docname) for docname in site_map]


def _read(book: Path, docname: str) -> Iterator[Page]:
    """Yield the page if it is executed."""
    name = docname.removesuffix(".md")
    path = (book / name).with_name(Path(name).name + ".md")
    if not path.is_file():
        raise PageError(f"_toc.yml names {docname!r}, but there is no {path}. Pages are .md files.")
    notebook = _notebook(name, path)
    if notebook is None:
        return
    if "name" not in notebook.metadata.get("kernelspec", {}):
        raise PageError(f"{name}: front matter needs `kernelspec: {{name: python3}}`.")
    if notebook.metadata.get("execution", {}).get("allow_errors"):
        raise PageError(
            f"{name}: `execution: allow_errors` would publish failing cells; "
            "tag the one cell `raises-exception` and say what it `expects`."
        )
    yield Page(name, path, notebook, *_declared(name, notebook))


def _notebook(name: str, path: Path) -> NotebookNode | None:
    """Return the parsed page, None for one of text alone."""
    try:
        text = path.read_text("utf8")
        # Read first: a front matter that does not parse makes MyST-NB take a notebook for text.
        notebook = deepcopy(_parsed(path, text)) if text.startswith("---") else None
    except Exception as error:  # the reader has no exception of its own for half of its complaints
        raise PageError(
            f"{name}: the page cannot be read: {error}\n"
            f"Mend {path}; front matter and the options of cells (`:name: value`) are YAML."
        ) from error
    return notebook if is_myst_markdown_notebook(text) else None


@lru_cache(maxsize=64)
def _parsed(path: Path, text: str) -> NotebookNode:
    """Return a page as a notebook; a build asks for each of them several times."""
    return myst_nb_reader_plugin(str(path))


def _declared(name: str, notebook: NotebookNode) -> tuple[str | None, str | None]:
    """Return lesson and page of the front matter, both None if it declares none."""
    declared = notebook.metadata.get(PACKAGE)
    if declared is None:
        return None, None
    parts = [declared.get(key) for key in ("lesson", "page")] if isinstance(declared, dict) else []
    if not parts or not all(isinstance(part, str) and part.isidentifier() for part in parts):
        raise PageError(
            f"{name}: front matter has `{PACKAGE}: {declared!r}`; "
            f"valid is `{PACKAGE}: {{lesson: l04, page: lab}}`, both plain words."
        )
    return parts[0], parts[1]


def cell_sources(page: Page) -> list[str]:
    """Return the page's code cells as plain Python, IPython's magics translated."""
    transform = TransformerManager().transform_cell
    return [transform(cell.source) for cell in page.notebook.cells if cell.cell_type == "code"]


def code_digest(page: Page) -> str:
    """Return the sha256 of the page's code cells as they are written; prose does not count."""
    cells = [cell.source for cell in page.notebook.cells if cell.cell_type == "code"]
    return hashlib.sha256(json.dumps(cells).encode()).hexdigest()


def imported_modules(sources: Iterable[str], root: Path = ROOT) -> dict[str, Path]:
    """Return the package's modules that some sources import, directly or through others.

    Args:
        sources: Python sources; one that does not parse counts as importing nothing, its page
            fails when it is executed.
        root: the folder that holds the package.

    Returns:
        Module name to file, packages by their `__init__.py`.
    """
    found: dict[str, Path] = {}
    waiting = [name for source in sources for name in _imports(source, "")]
    while waiting:
        for name in _with_parents(waiting.pop()):
            path = _module_file(root, name)
            if path is None or name in found:
                continue
            found[name] = path
            is_package = path.name == "__init__.py"
            waiting += _imports(path.read_text("utf8"), name if is_package else _parent(name))
    return found


def _imports(source: str, package: str) -> list[str]:
    """Return the dotted names below the course package that a source imports anywhere."""
    try:
        tree = ast.parse(source)
    except SyntaxError:
        return []
    names: list[str] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1]
            base = ".".join([*(above if node.level else []), *filter(None, [node.module])])
            names += [base, *(f"{base}.{alias.name}" for alias in node.names)]
    return [name for name in names if name.split(".")[0] == PACKAGE]


def _parent(name: str) -> str:
    return name.rpartition(".")[0]


def _with_parents(name: str) -> list[str]:
    parts = name.split(".")
    return [".".join(parts[: count + 1]) for count in range(len(parts))]


def _module_file(root: Path, name: str) -> Path | None:
    """Return the file of a module; None for a dotted name that is an attribute of one."""
    base = root.joinpath(*name.split("."))
    candidates = (base.with_name(base.name + ".py"), base / "__init__.py")
    return next((path for path in candidates if path.is_file()), None)


def fingerprint(
    pages: Iterable[Page], root: Path = ROOT, environment: Mapping[str, str] | None = None
) -> str:
    """Return the name of everything, apart from the pages' own code, that decides their outputs.

    jupyter-cache compares code cells alone; so its folder is named by this digest of the lock, all
    installed versions, the package modules that the pages import, the package's data files, the
    environment contract and the Python version.

    Args:
        pages: the executed pages.
        root: the checkout.
        environment: variables, by default those of this process.

    Returns:
        20 hex digits.
    """
    sources = [source for page in pages for source in cell_sources(page)]
    files = list(imported_modules(sources, root).values())
    files += [path for path in (root / PACKAGE).rglob("*") if path.suffix in DATA_SUFFIXES]
    digests = {
        path.relative_to(root).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }
    parts = {
        "lock": lock_digest(root),
        "installed": installed_packages(),
        "python": platform.python_version(),
        "environment": environment_contract(environment),
        "files": digests,
    }
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:20]
