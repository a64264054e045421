"""Finds the runs that made a part of a page: that of a cell, those of a shown bundle, or none."""

from collections.abc import Iterator
from typing import Any

from docutils import nodes

from .runs import BACKEND

# The tag of a cell whose tables contain only chosen values, no measured ones
INPUTS = "inputs"


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


def origin(
    node: nodes.Node, page: str | None
) -> tuple[tuple[str, ...] | None, nodes.Element | None]:
    """Return the keys of the runs that made a node, and the cell whose output it is.

    The nodes of a cell's output are recognized by attributes that MyST-NB sets, never
    by a class, which a page could set.

    Args:
        node: a part of a page.
        page: `lesson/page` of that page, None where it declares no bundle.

    Returns:
        Keys: () where a cell shows chosen values, None where neither a cell nor a bundle
        made the node. The cell: None for a node that no cell made, or that was read from
        a bundle.
    """
    cell = None
    for element in above(node):
        if "evidence_runs" in element:
            return tuple(element["evidence_runs"]), None
        if element.get("nb_element") in MADE_BY_CELL:
            cell = element
    if cell is None:
        return None, None
    chosen = INPUTS in cell.get("cell_metadata", {}).get("tags", [])
    return () if chosen else (f"{page}/{BACKEND}",), cell
