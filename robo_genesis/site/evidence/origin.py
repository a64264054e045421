"""Finds the runs that made a part of a page: that of a cell, those of a shown bundle, or none."""

from collections.abc import Iterator
from typing import Any

from docutils import nodes

from robo_genesis.site.evidence.runs import BACKEND

# The tag of a cell whose tables contain only chosen values, no measured ones
INPUTS = "inputs"


NO_BUNDLE = ("",)

# What MyST-NB calls the parts of a page that are the output of a cell.
MADE_BY_CELL = {"cell_code", "mime_bundle"}


def above(
    node: nodes.Node, kind: type | tuple[type, ...] = nodes.Element
) -> Iterator[Any]:
    """Yield the ancestors of a node that have some type, the nearest first."""
    while node.parent is not None:
        node = node.parent
        if isinstance(node, kind):
            yield node


def origin(node: nodes.Node, page: str | None) -> tuple[str, ...] | None:
    """Return the keys of the runs that made a node.

    The nodes of a cell's output are recognized by attributes that MyST-NB sets, never
    by a class, which a page could set.

    Args:
        node: a part of a page.
        page: `lesson/page` of that page, None where it declares no bundle.

    Returns:
        () where a cell shows chosen values, None where neither a cell nor a bundle made
        the node, `NO_BUNDLE` where a cell made it and the page declares no bundle.
    """
    for element in above(node):
        if "evidence_runs" in element:
            return tuple(element["evidence_runs"])
    cell = cell_of(node)
    if cell is None:
        return None
    if INPUTS in cell.get("cell_metadata", {}).get("tags", []):
        return ()
    return (f"{page}/{BACKEND}",) if page else NO_BUNDLE


def cell_of(node: nodes.Node) -> nodes.Element | None:
    """Return the cell whose output a node is.

    Returns:
        None for a node that no cell made, or that was read from a bundle.
    """
    found = None
    for element in above(node):
        if "evidence_runs" in element:
            return None
        if element.get("nb_element") in MADE_BY_CELL:
            found = element
    return found
