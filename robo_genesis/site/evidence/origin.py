"""Which runs made a part of a page: a cell's, those of a bundle that is shown, or none."""

from collections.abc import Iterator
from typing import Any

from docutils import nodes
from myst_nb.ext.glue.directives import PasteAnyDirective, PasteMarkdownDirective
from sphinx.application import Sphinx

from robo_genesis.site.evidence.measured import BACKEND

INPUTS = "inputs"
"""The tag of a cell whose tables hold what was chosen, and nothing that was measured."""


def above(node: nodes.Node, kind: type = nodes.Element) -> Iterator[Any]:
    """Yield the nodes that hold a node, those of one type, the nearest first."""
    while node.parent is not None:
        node = node.parent
        if isinstance(node, kind):
            yield node


def origin(node: nodes.Node, page: str | None) -> tuple[str, ...] | None:
    """Return the keys of the runs that made a node.

    The nodes that a cell's output leaves are known by what MyST-NB writes into them, never by a
    class, which a page could set.

    Args:
        node: a part of a page.
        page: `lesson/page` of that page, None where it declares no bundle.

    Returns:
        () where a cell shows what was chosen, None where neither a cell nor a bundle made the
        node, ("",) where a cell did and the page declares no bundle.
    """
    parents = list(above(node))
    for element in parents:
        if "evidence_runs" in element:
            return tuple(element["evidence_runs"])
    made = {element.get("nb_element"): element for element in parents}
    if "cell_code" in made and INPUTS in made["cell_code"]["cell_metadata"].get("tags", []):
        return ()
    if made.keys() & {"cell_code", "mime_bundle", "glued"}:
        return (f"{page}/{BACKEND}" if page else "",)
    return None


class Glued:
    """Marks what a directive pastes as the output of a cell, which it is."""

    def run(self) -> list[nodes.Node]:
        """Return the directive's nodes in a container."""
        return [nodes.container("", *super().run(), classes=["glued"], nb_element="glued")]  # type: ignore[misc]


class GluedAny(Glued, PasteAnyDirective):
    """Paste an output in whatever form it has."""


class GluedMarkdown(Glued, PasteMarkdownDirective):
    """Paste an output as Markdown; without the mark its tables look like typed ones."""


def register(app: Sphinx) -> None:
    """Register the mark on what is glued."""
    app.add_directive("glue", GluedAny, override=True)
    for name, directive in (("", GluedAny), ("any", GluedAny), ("md", GluedMarkdown)):
        app.add_directive_to_domain("glue", name, directive, override=True)
