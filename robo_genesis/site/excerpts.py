"""Excerpts of the package on pages: `literalinclude` of Python leaves docstrings out."""

import ast
import textwrap

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.directives.code import LiteralInclude

LEFT_OUT = "\0"
"""Marks a line of a docstring; no Python contains it."""


class Excerpt(LiteralInclude):
    """Include a part of a file; of Python without docstrings."""

    def run(self) -> list[nodes.Node]:
        """Return what Sphinx returns, the code without docstrings."""
        found = super().run()
        if self.options.get("language") == "python":
            for block in (b for node in found for b in node.findall(nodes.literal_block)):
                code = without_docstrings(block.astext())
                block.rawsource, block.children = code, []
                block += nodes.Text(code)
        return found


def without_docstrings(code: str) -> str:
    """Return Python without docstrings, those of constants and fields included.

    Args:
        code: whole statements at any indentation; anything else is returned unchanged.
    """
    try:
        tree = ast.parse(textwrap.dedent(code))
    except SyntaxError:
        return code
    lines = code.splitlines()
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if not isinstance(body, list) or all(map(_is_docstring, body)):
            continue
        for part in filter(_is_docstring, body):
            first, last = part.lineno - 1, part.end_lineno
            if body[0] is part and not lines[last].strip():
                last += 1  # the empty line after the docstring of a function
            lines[first:last] = [LEFT_OUT] * (last - first)
    return "\n".join(line for line in lines if line != LEFT_OUT) + "\n"


def _is_docstring(node: ast.AST) -> bool:
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def setup(app: Sphinx) -> None:
    """Register the directive in place of Sphinx's own."""
    app.add_directive("literalinclude", Excerpt, override=True)
