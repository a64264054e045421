"""The time that each page's code cells took: ```` ```{cell-times} ````.

The store of executed pages holds the seconds of each cell.
"""

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
        rows = []
        for page in find_pages(self.book):
            seconds = cell_seconds(page.docname)
            row = {"page": f"[](/{page.docname}.md)", "code cells": len(seconds)}
            rows.append(row | {"all cells [s]": f"{sum(seconds):.1f}"})
        return self.parse_text_to_nodes(tables.markdown(rows))


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("cell-times", CellTimes)
