"""What code does: a digest of its syntax tree, and what it imports. Nothing is imported or run."""

import ast
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import resolve_name
from itertools import groupby
from typing import Any

from robo_genesis.core.files import derived_value, json_digest

PACKAGE = "robo_genesis"
NOT_CODE = ("kind", "type_comment")  # Fields of a syntax tree that decide nothing


# How a module says that no measured value depends on it, and so no evidence key.
MEASURES_NOTHING = "MEASURES = False"


@dataclass(frozen=True, slots=True)
class ModuleCode:
    """What a module does.

    `digest` is the sha256 of its syntax tree, `imports` has the dotted names below the
    course package that it imports anywhere, of modules or of something in a module.
    `claims` has the docstrings of its checks by name. `measures` is false in a module
    that says `MEASURES = False`.
    """

    digest: str
    imports: list[str]
    claims: dict[str, str]
    measures: bool


@lru_cache(maxsize=1024)
def read_module(source: str, package: str = "") -> ModuleCode:
    """Return what a module does, by its syntax tree and not by its text.

    Comments, layout, quotes and strings that are statements of their own do not count.
    Python 3.11 to 3.14 give the same digest, because fields that are empty or have to
    do with positions are left out, and the constant parts of f-strings are joined. An
    exception is a backslash in the format of an f-string: Python 3.11 and later
    versions read it differently.

    Args:
        source: Python. One that does not parse counts by its text.
        package: the package of the module, to which relative imports refer.
    """

    def make() -> dict[str, Any]:
        tree = _parsed(source)
        lines = map(ast.unparse, tree.body if tree else ())
        return {
            "digest": json_digest(_canonical(tree) if tree else source),
            "imports": [*_imports(tree, package)],
            "claims": dict(_claims(tree)),
            "measures": MEASURES_NOTHING not in lines,
        }

    return ModuleCode(**derived_value("module", [source, package], make))


def _parsed(source: str) -> ast.Module | None:
    """Return the syntax tree of a source, None if it does not parse."""
    with suppress(SyntaxError, ValueError):
        return ast.parse(source)
    return None


@dataclass(frozen=True, slots=True)
class Code:
    """The code cells of a page.

    `sources` are plain Python, in which magics of IPython are translated; `digests` has
    that of the syntax of each cell; `imports` has the dotted names below the course
    package that they import.
    """

    sources: list[str]
    digests: list[str]
    imports: list[str]


def read_code(cells: Iterable[str]) -> Code:
    """Return what the code cells of a page do, from their texts."""
    texts = list(cells)

    def make() -> dict[str, list[str]]:
        sources = [plain_python(text) for text in texts]
        return {
            "sources": sources,
            "digests": [cell_digest(source) for source in sources],
            "imports": sorted(
                {name for source in sources for name in _imports(_parsed(source))}
            ),
        }

    return Code(**derived_value("code", texts, make))


def plain_python(cell: str) -> str:
    """Return the code of a cell as Python, its magics translated."""
    from IPython.core.inputtransformer2 import (
        TransformerManager,
    )  # which no verification loads

    try:
        return TransformerManager().transform_cell(cell)
    except SyntaxError:  # of indentation; the execution reports its line
        return cell


def cell_digest(source: str) -> str:
    """Return the sha256 of the syntax of one code cell, in which IPython's magics are translated.

    A string that is a statement counts, other than in a module, because it may be the
    output of the cell. So does a semicolon at the end, which hides the output.
    """
    tree = _parsed(source)
    if tree is None:
        return json_digest(source)
    statements = [_canonical(statement) for statement in tree.body]
    return json_digest([statements, _ends_with_semicolon(source, tree.body)])


def _canonical(node: Any) -> Any:
    """Return a syntax tree as nested lists, the same in each version of Python."""
    if isinstance(node, list):
        return [_canonical(each) for each in node if not is_text(each)]
    if isinstance(node, ast.Constant):
        return ["Constant", type(node.value).__name__, ascii(node.value)]
    if not isinstance(node, ast.AST):
        return node
    fields = dict(ast.iter_fields(node))
    if isinstance(node, ast.JoinedStr):
        fields["values"] = list(_joined(node.values))
    found = {n: _canonical(value) for n, value in fields.items() if n not in NOT_CODE}
    return [
        type(node).__name__,
        {n: value for n, value in found.items() if value not in (None, [])},
    ]


def is_text(statement: ast.AST) -> bool:
    """Return whether a statement is only a string, as docstrings are."""
    value = statement.value if isinstance(statement, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def _joined(parts: Iterable[ast.expr]) -> Iterator[ast.expr]:
    """Yield the parts of an f-string with adjacent constants joined and empty ones left out."""
    for constant, group in groupby(parts, lambda part: isinstance(part, ast.Constant)):
        if not constant:
            yield from group
        elif text := "".join(part.value for part in group):  # type: ignore[attr-defined]
            yield ast.Constant(text)


def _ends_with_semicolon(source: str, statements: Sequence[ast.stmt]) -> bool:
    """Whether a semicolon follows the last statement, before any comment."""
    end = statements[-1] if statements else None
    if end is None or end.end_lineno is None:
        return False
    line = source.encode().splitlines()[end.end_lineno - 1]
    return line[end.end_col_offset :].lstrip().startswith(b";")


def _claims(tree: ast.AST | None) -> Iterator[tuple[str, str]]:
    """Yield name and docstring of each function that yields findings."""
    for node in ast.walk(tree) if tree else ():
        if (
            isinstance(node, ast.FunctionDef)
            and node.returns
            and ast.unparse(node.returns) == "Findings"
        ):
            yield node.name, ast.get_docstring(node) or ""


def _imports(tree: ast.AST | None, package: str = "") -> Iterator[str]:
    """Yield the names below the course package; a relative one needs the module's package."""
    for node in ast.walk(tree) if tree else ():
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and (package or not node.level):
            base = resolve_name("." * node.level + (node.module or ""), package)
            names = [base, *(f"{base}.{alias.name}" for alias in node.names)]
        yield from (name for name in names if name.split(".")[0] == PACKAGE)
