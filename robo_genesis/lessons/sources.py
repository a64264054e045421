"""The code behind a page: what it imports, a digest of its syntax, and the keys that follow.

Two keys use it. The *evidence key* of a bundle covers the modules that compute its numbers. The
*fingerprint* of a page decides whether the page has to run again, and covers whatever it imports.
Nobody lists modules: both follow the import statements of the sources, which are never imported.
"""

import ast
import hashlib
import io
import json
import os
import platform
import tokenize
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, cached_property, lru_cache, partial
from importlib.util import resolve_name
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robo_genesis.core.files import derived
from robo_genesis.core.project import (
    ROOT,
    environment_contract,
    installed_packages,
    lock_digest,
)

if TYPE_CHECKING:
    from robo_genesis.lessons.book_pages import Page

PACKAGE = "robo_genesis"
DATA_SUFFIXES = (".json", ".toml", ".yaml", ".yml", ".csv")

COMPUTING = ("core", "sim", "lessons")
"""The sub-packages with modules that compute."""

NOT_COMPUTING = {
    "spec", "plausibility",  # what a run is given (see `parameters`), and what is refused
    "channels", "comparison", "explorer", "mistake", "mistakes", "palette", "plots", "plotting",
    "tables", "text",  # what is shown
    "exercises",  # what is checked of a reader's own code
    "project",  # where files are
}  # fmt: skip
"""The last words of the names of modules that are in no evidence key: `study_spec`, `text` …"""

QUIET = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.ENDMARKER)


@lru_cache(maxsize=1024)
def syntax_digest(source: str) -> str:
    """Return the sha256 of what a module does: of its syntax tree, not of its text.

    Comments, layout, quotes and strings that are statements of their own do not count. Python
    3.11 to 3.14 give the same digest, because fields that are empty or have to do with positions
    are left out, and the constant parts of f-strings are joined. An exception is a backslash in the
    format of an f-string: Python 3.11 and later versions read it differently.

    Args:
        source: Python. One that does not parse counts by its text.
    """

    def make() -> bytes:
        try:
            tree = ast.parse(source)
        except (SyntaxError, ValueError):
            return _sha256(source).encode()
        return _sha256(_canonical(tree)).encode()

    return derived("syntax", [source.encode(), _own_source()], make).decode()


def cell_digests(cells: Sequence[str]) -> list[str]:
    """Return the digest of each code cell of a page; see `cell_digest`."""
    inputs = [json.dumps(cells).encode(), _own_source()]
    made = derived("cells", inputs, lambda: json.dumps([*map(cell_digest, cells)]).encode())
    digests: list[str] = json.loads(made)
    return digests


def cell_digest(source: str) -> str:
    """Return the sha256 of the syntax of one code cell, in which IPython's magics are translated.

    A string that is a statement counts, other than in a module, because it may be the output of the
    cell. So does a semicolon at the end, which hides the output.
    """
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):
        return _sha256(source)
    statements = [_canonical(statement) for statement in tree.body]
    return _sha256([statements, _ends_with_semicolon(source)])


def _canonical(node: Any) -> Any:
    """Return a syntax tree as nested lists, the same in each version of Python."""
    if isinstance(node, list):
        return [_canonical(each) for each in node]
    if isinstance(node, ast.Constant):
        return ["Constant", type(node.value).__name__, ascii(node.value)]
    if not isinstance(node, ast.AST):
        return node
    fields = dict(ast.iter_fields(node))
    fields.pop("kind", None)
    fields.pop("type_comment", None)
    if isinstance(node, ast.JoinedStr):
        fields["values"] = list(_joined(node.values))
    for name in ("body", "orelse", "finalbody"):
        if isinstance(fields.get(name), list):
            fields[name] = [s for s in fields[name] if not _is_text(s)]
    filled = {
        name: _canonical(value)
        for name, value in fields.items()
        if value is not None and value != []
    }
    return [type(node).__name__, filled]


def _is_text(statement: ast.AST) -> bool:
    """Whether a statement is only a string, as docstrings are."""
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def _joined(parts: Iterable[ast.expr]) -> Iterator[ast.expr]:
    """Yield the parts of an f-string with adjacent constants joined and empty ones left out."""
    text = ""
    for part in parts:
        if isinstance(part, ast.Constant) and isinstance(part.value, str):
            text += part.value
            continue
        if text:
            yield ast.Constant(text)
        text = ""
        yield part
    if text:
        yield ast.Constant(text)


def _ends_with_semicolon(source: str) -> bool:
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    words = [token.string for token in tokens if token.type not in QUIET and token.string]
    return words[-1:] == [";"]


def _sha256(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


@lru_cache(maxsize=1024)
def imported_names(source: str, package: str = "") -> tuple[str, ...]:
    """Return the dotted names below the course package that a source imports anywhere.

    A name may be that of a module or of something in a module.

    Args:
        source: Python. One that does not parse imports nothing: its page fails when it is executed.
        package: the package of the source, to which relative imports refer.
    """
    inputs = [source.encode(), package.encode(), _own_source()]
    made = derived("imports", inputs, lambda: " ".join(_names(source, package)).encode())
    return tuple(made.decode().split())


def _names(source: str, package: str) -> list[str]:
    names: list[str] = []
    try:
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Import):
                names += [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                base = resolve_name("." * node.level + (node.module or ""), package)
                names += [base, *(f"{base}.{alias.name}" for alias in node.names)]
    except (SyntaxError, ValueError, ImportError):
        return []
    return [name for name in names if name.split(".")[0] == PACKAGE]


def imports_of(cells: Sequence[str]) -> list[str]:
    """Return the dotted names below the course package that the code cells of a page import."""
    found = derived(
        "cell-imports",
        [json.dumps(cells).encode(), _own_source()],
        lambda: " ".join(sorted({n for cell in cells for n in _names(cell, "")})).encode(),
    )
    return found.decode().split()


class Tree:
    """The files of the package below a folder, each looked for and read once, for several pages."""

    def __init__(self, root: Path = ROOT) -> None:
        self.root = root
        self.module: Callable[[str], Path | None] = cache(partial(_module_file, root))
        self.text: Callable[[Path], str] = cache(partial(Path.read_text, encoding="utf8"))

    @cached_property
    def data(self) -> dict[Path, str]:
        """The digest of each data file."""
        files = (self.root / PACKAGE).rglob("*")
        return {
            path: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in files
            if path.suffix in DATA_SUFFIXES
        }

    def data_for(self, lesson: str | None) -> dict[str, str]:
        """Return the digests of the data files by name, except those of other lessons."""
        lessons = self.root / PACKAGE / "lessons"
        others = {init.parent for init in lessons.glob("*/__init__.py")} - {lessons / f"{lesson}"}
        return {
            path.relative_to(self.root).as_posix(): digest
            for path, digest in self.data.items()
            if others.isdisjoint(path.parents)
        }


def import_closure(
    names: Iterable[str],
    root: Path = ROOT,
    enter: Callable[[str, Path], bool] = lambda name, path: True,
    tree: Tree | None = None,
) -> dict[str, Path]:
    """Return the package's modules behind some dotted names, directly or through others.

    Args:
        names: of modules or of something in them; others are ignored.
        root: the folder that holds the package.
        enter: whether a module belongs to the result; what only others import does not.
        tree: the files below `root`, if they were read before.

    Returns:
        Module name to file, packages by their `__init__.py`.
    """
    tree = tree or Tree(root)
    found: dict[str, Path] = {}
    waiting = list(names)
    seen: set[str] = set()
    while waiting:
        for name in accumulate(waiting.pop().split("."), "{}.{}".format):
            path = None if name in seen else tree.module(name)
            seen.add(name)
            if path is None or not enter(name, path):
                continue
            found[name] = path
            package = name if path.name == "__init__.py" else name.rpartition(".")[0]
            waiting += imported_names(tree.text(path), package)
    return found


def _module_file(root: Path, name: str) -> Path | None:
    """Return the file of a module, None if the name is not a module."""
    base = os.path.join(root, *name.split("."))  # called for thousands of names
    candidates = (f"{base}.py", os.path.join(base, "__init__.py"))
    return next((Path(path) for path in candidates if os.path.isfile(path)), None)


def _lesson_modules(lesson: str, root: Path) -> list[str]:
    """Return the modules in the folder of a lesson."""
    folder = root / PACKAGE / "lessons" / lesson
    return [f"{PACKAGE}.lessons.{lesson}.{path.stem}" for path in sorted(folder.glob("*.py"))]


def computes(name: str, path: Path) -> bool:
    """Whether a module belongs to evidence keys, if a measuring page uses it.

    It is in `core`, `sim` or `lessons`, it is not the `__init__.py` of a package, and the last word
    of no part of its name is one of `NOT_COMPUTING`.
    """
    sub_package, *parts = name.removeprefix(f"{PACKAGE}.").split(".")
    words = {part.rpartition("_")[2] for part in parts}
    inside = sub_package in COMPUTING and path.name != "__init__.py"
    return inside and words.isdisjoint(NOT_COMPUTING)


def measuring_modules(lesson: str, imports: Iterable[str], root: Path = ROOT) -> dict[str, str]:
    """Return the modules that decide what a page measures, with the digests of their syntax.

    They are all modules of the lesson that compute, what its `__init__.py` imports from `sim`, what
    the page itself imports, and what these import; see `computes`.

    Args:
        lesson: the name of its folder.
        imports: what the cells of the page import, see `imports_of`.
        root: the checkout.

    Returns:
        Module without the package's name, such as `core.trace`, to digest.
    """
    own = f"{PACKAGE}.lessons.{lesson}"
    init = _module_file(root, own)
    given = imported_names(init.read_text("utf8"), own) if init else ()
    of_sim = [name for name in given if name.startswith(f"{PACKAGE}.sim.")]
    roots = [*_lesson_modules(lesson, root), *of_sim, *imports]
    modules = import_closure(roots, root, enter=computes)
    return {
        name.removeprefix(f"{PACKAGE}."): syntax_digest(path.read_text("utf8"))
        for name, path in sorted(modules.items())
    }


def page_fingerprint(
    page: "Page",
    root: Path = ROOT,
    environment: Mapping[str, str] | None = None,
    tree: Tree | None = None,
) -> str:
    """Return a digest of everything that decides the outputs of a page.

    It covers the lock, all installed versions, the version of Python, the environment contract,
    whether the page is executed alone, the syntax of the page's cells, of the modules that they
    import and of the modules of its lesson, and the data files of the package, except those of
    other lessons.

    Args:
        page: an executed page.
        root: the checkout.
        environment: variables, by default those of this process.
        tree: the files below `root`, if they were read before.

    Returns:
        20 hex digits.
    """
    # Imported here, because MyST-NB and Jupyter take longer to load than a whole verification.
    from robo_genesis.lessons.book_pages import cell_sources

    tree, cells = tree or Tree(root), cell_sources(page)
    own = _lesson_modules(page.lesson, root) if page.lesson else []
    modules = import_closure([*imports_of(cells), *own], root, tree=tree)
    parts = {
        "lock": lock_digest(root),
        "installed": _installed(),
        "python": platform.python_version(),
        "environment": environment_contract(environment),
        "cells": cell_digests(cells),
        "modules": {name: syntax_digest(tree.text(path)) for name, path in modules.items()},
        "data": tree.data_for(page.lesson),
        "alone": page.alone,
    }
    return _sha256(parts)[:20]


@lru_cache(maxsize=1)
def _own_source() -> bytes:
    return Path(__file__).read_bytes()


@lru_cache(maxsize=1)
def _installed() -> list[str]:
    names: list[str] = json.loads(
        derived("packages", [], lambda: json.dumps(installed_packages()).encode())
    )
    return names
