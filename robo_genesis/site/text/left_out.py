"""What pages leave out: docstrings in excerpts of the package, and, with `SOLUTIONS=0`, solutions.

Solutions and answers are left out of pages and search index, and of the executed
notebooks. The pages' sources, which contain them, are not published. A question that
the page itself marks keeps its feedback.
"""

import ast
import textwrap

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.directives.code import LiteralInclude
from sphinx.transforms import SphinxTransform

from robo_genesis.core.project import solutions_shown
from robo_genesis.pipeline.pages.page_rules import NO_SOLUTION, SOLUTION
from robo_genesis.pipeline.pages.syntax import is_text

MARKS = {
    SOLUTION,
    f"tag_{SOLUTION}",
}  # The second is the class that a code cell has from its tag

LEFT_OUT = "\0"  # Marks a line of a docstring; no Python contains it


class Excerpt(LiteralInclude):
    """Include a part of a file; of Python without docstrings."""

    def run(self) -> list[nodes.Node]:
        """Return what Sphinx returns, the code without docstrings."""
        found = super().run()
        if self.options.get("language") == "python":
            for block in (
                b for node in found for b in node.findall(nodes.literal_block)
            ):
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
        if not isinstance(body, list) or all(map(is_text, body)):
            continue
        for part in filter(is_text, body):
            first, last = part.lineno - 1, part.end_lineno
            if body[0] is part and not lines[last].strip():
                last += 1  # the empty line after the docstring of a function
            lines[first:last] = [LEFT_OUT] * (last - first)
    return "\n".join(line for line in lines if line != LEFT_OUT) + "\n"


class LeaveOutSolutions(SphinxTransform):
    """Remove what is marked as a solution, before anything refers to it."""

    default_priority = 200

    def apply(self, **kwargs: object) -> None:
        """Remove them from the page."""
        for node in [*self.document.findall(nodes.Element)]:
            if MARKS.intersection(
                (*node["classes"], *node.get("container_classes", ()))
            ):
                cell = (
                    "cell" in node["classes"]
                )  # The outputs of cells below follow from it
                said = [nodes.paragraph("", "", nodes.emphasis("", NO_SOLUTION))] * cell
                place = node.parent.index(node)
                node.parent[place : place + 1] = said


def hide_sources(app: Sphinx, config: Config) -> None:
    """Publish no page's source."""
    config.html_copy_source = False
    config.html_theme_options["use_download_button"] = False  # it leads to the source


def setup(app: Sphinx) -> None:
    """Register what leaves docstrings out, and solutions if they are not shown."""
    app.add_directive("literalinclude", Excerpt, override=True)
    if not solutions_shown():
        app.add_transform(LeaveOutSolutions)
        app.connect("config-inited", hide_sources)
