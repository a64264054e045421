"""The time that each page's code cells took: ```` ```{cell-times} ````.

The store of executed pages holds the seconds of each cell.
"""

from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core import tables
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.page_index import cell_seconds
from robo_genesis.site.pages import PageDirective


class CellTimes(PageDirective):
    """Show a table with one row for each executed page of the book."""

    def shown(self) -> list[nodes.Node]:
        """Return the table."""
        pages = find_pages(Path(self.env.srcdir))
        rows = [row(page.docname, cell_seconds(page.docname)) for page in pages]
        return self.parse_text_to_nodes(tables.markdown(rows))


def row(docname: str, seconds: list[float]) -> dict[str, str | int]:
    """Return one row of the table; cells are counted from 1, times are in seconds."""
    slowest = max(range(len(seconds)), key=seconds.__getitem__)
    return {
        "page": f"[](/{docname}.md)",
        "code cells": len(seconds),
        "all cells [s]": f"{sum(seconds):.1f}",
        "slowest cell": slowest + 1,
        "its time [s]": f"{seconds[slowest]:.1f}",
    }


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("cell-times", CellTimes)
