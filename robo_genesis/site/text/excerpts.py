"""Excerpts of the package in pages, without docstrings: ```` ```{literalinclude} ````."""

import ast
import textwrap
from pathlib import Path

from docutils import nodes
from myst_parser.parsers.directives import parse_directive_text
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.directives.code import LiteralInclude, LiteralIncludeReader

from robo_genesis.pipeline.pages.syntax import is_text


class Excerpt(LiteralInclude):
    """Include a part of a file; of Python without docstrings."""

    def run(self) -> list[nodes.Node]:
        """Return what Sphinx returns, the code without docstrings."""
        shown = super().run()
        if self.options.get("language") == "python":
            for block in (b for n in shown for b in n.findall(nodes.literal_block)):
                code = without_docstrings(block.astext())
                block.rawsource, block.children = code, []
                block += nodes.Text(code)
        return shown


def excerpt(folder: Path, first_line: str, content: str) -> str:
    """Return the part of a file that a `literalinclude` on a page in a folder names."""
    parsed = parse_directive_text(LiteralInclude, first_line, content)
    path = (folder / parsed.arguments[0]).resolve()
    return LiteralIncludeReader(str(path), parsed.options, Config()).read()[0]


def without_docstrings(code: str) -> str:
    """Return Python without docstrings, those of constants and fields included.

    Args:
        code: whole statements at any indentation; anything else is returned unchanged.
    """
    try:
        tree = ast.parse(textwrap.dedent(code))
    except SyntaxError:
        return code
    lines: list[str | None] = [*code.splitlines()]
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if not isinstance(body, list) or all(map(is_text, body)):
            continue
        for part in filter(is_text, body):
            first, last = part.lineno - 1, part.end_lineno
            if body[0] is part and not (lines[last] or "").strip():
                last += 1  # the empty line after the docstring of a function
            lines[first:last] = [None] * (last - first)
    return "\n".join(line for line in lines if line is not None) + "\n"


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("literalinclude", Excerpt, override=True)
