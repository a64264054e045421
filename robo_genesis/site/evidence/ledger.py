"""The ledger: every run, figure, measured table and printed text, with digests and downloads.

A page writes ```` ```{ledger} runs ```` and ```` ```{ledger} items ````. Both are
filled in after all pages are read; the files to download are written then.
"""

from functools import partial
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.files import bytes_digest, write_whole
from robo_genesis.core.markup import filled
from robo_genesis.pipeline.html.archive import contents, zipped
from robo_genesis.pipeline.pages.book import page_files
from robo_genesis.site.pages import PageDirective

from .plain_nodes import late
from .provenance import ITEMS
from .runs import all_runs, badge, measured_pages

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
    runs, archives = all_runs(Path(app.srcdir)).values(), {}
    for run in runs:
        if run.manifest is not None:
            name = f"{run.key.replace('/', '-')}-{run.manifest.run_id[:8]}.zip"
            content = zipped(contents(run.folder))
            archives[run.key] = name, bytes_digest(content)
            write_whole(Path(app.outdir) / DOWNLOADS / name, content)
    return _filled("ledger_runs.html", docname, runs=runs, archives=archives)


def item_list(app: Sphinx, docname: str) -> str:
    """Return the table of all items on the pages, in the order of the pages."""
    book, env = Path(app.srcdir), app.env
    runs, rows = all_runs(book), []
    for name in page_files(book):
        for item in env.metadata[name][ITEMS]:
            rows.append((item, [runs[key] for key in item.runs]))
            if item.data is not None:
                write_whole(Path(app.outdir) / DOWNLOADS / item.file, item.data)
    return _filled(
        "ledger_items.html",
        docname,
        items=rows,
        pages=measured_pages(book),
        images=env.images,
        link=partial(app.builder.get_relative_uri, docname),
    )


def _filled(template: str, docname: str, **values: Any) -> str:
    up = "../" * docname.count("/")
    downloads = f"{up}{DOWNLOADS}"
    place = Path(__file__).with_name(template)
    return filled(place, badge=badge, up=up, downloads=downloads, **values)


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("ledger", Ledger)
