"""The ledger: every run, figure, measured table and printed text, with digests and downloads.

A page writes ```` ```{ledger} runs ```` and ```` ```{ledger} items ````. Both are
filled in after all pages are read.
"""

from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.files import write_whole
from robo_genesis.core.markup import filled
from robo_genesis.pipeline.pages.book import page_files
from robo_genesis.site.evidence import ledger_data
from robo_genesis.site.evidence.plain_nodes import late
from robo_genesis.site.evidence.provenance import ITEMS
from robo_genesis.site.evidence.runs import all_runs, badge, measured_pages
from robo_genesis.site.pages import PageDirective

DOWNLOADS = "_downloads/evidence"


class Ledger(PageDirective):
    """List all runs, or all figures, tables and printed texts of the site."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the place of the list."""
        self.env.note_reread()
        parts = {"runs": run_list, "items": item_list}
        return [late(make=parts[self.arguments[0]])]


def run_list(app: Sphinx, docname: str) -> str:
    """Return each run's facts and its bundle, or why it is missing and what creates it."""
    return _filled(
        "ledger_runs.html",
        docname,
        runs=all_runs(Path(app.srcdir)).values(),
        archive=ledger_data.archive,
        archive_name=ledger_data.archive_name,
        sha256=ledger_data.sha256,
    )


def item_list(app: Sphinx, docname: str) -> str:
    """Return the table of all items on the pages, in the order of the pages."""
    book, env = Path(app.srcdir), app.env
    runs = all_runs(book)
    items = chain.from_iterable(env.metadata[name][ITEMS] for name in page_files(book))
    return _filled(
        "ledger_items.html",
        docname,
        items=[(item, [runs[key] for key in item.runs]) for item in items],
        pages=measured_pages(book),
        images=env.images,
        link=partial(app.builder.get_relative_uri, docname),
    )


def _filled(template: str, docname: str, **values: Any) -> str:
    up = "../" * docname.count("/")
    downloads = f"{up}{DOWNLOADS}"
    place = Path(__file__).with_name(template)
    return filled(place, badge=badge, up=up, downloads=downloads, **values)


def write_downloads(app: Sphinx, exception: Exception | None) -> None:
    """Write the tables, texts and bundles that the ledger links to."""
    if exception is not None or ledger_data.LEDGER not in app.env.found_docs:
        return
    folder = Path(app.outdir) / DOWNLOADS
    for item in chain.from_iterable(
        page.get(ITEMS, ()) for page in app.env.metadata.values()
    ):
        if item.data is not None:
            write_whole(folder / item.file, item.data)
    for run in all_runs(Path(app.srcdir)).values():
        if run.manifest is not None:
            write_whole(
                folder / ledger_data.archive_name(run), ledger_data.archive(run.folder)
            )


def setup(app: Sphinx) -> None:
    """Register the directive and the writing of downloads."""
    app.add_directive("ledger", Ledger)
    app.connect("build-finished", write_downloads)
