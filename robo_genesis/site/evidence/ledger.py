"""The ledger: every run with its facts and its bundle. A page writes ```` ```{ledger} ````.

It is filled in after all pages are read; the bundles to download are written then.
"""

from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.files import bytes_digest, write_whole
from robo_genesis.core.markup import filled
from robo_genesis.pipeline.html.archive import contents, zipped
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.text.solutions import answer_left_out

from .plain_nodes import late
from .runs import all_runs, badge

DOWNLOADS = "_downloads/evidence"
TEMPLATE = Path(__file__).with_suffix(".html")


class Ledger(PageDirective):
    """List all runs of the site."""

    def shown(self) -> list[nodes.Node]:
        """Return the place of the list."""
        self.env.note_reread()
        return [late(make=run_list)]


def run_list(app: Sphinx, docname: str) -> str:
    """Return each run's facts and its bundle, or why it is missing and what creates it."""
    runs, archives = all_runs(Path(app.srcdir)).values(), {}
    for run in runs:
        if run.manifest is not None and not answer_left_out(run.page.split("/")[1]):
            name = f"{run.key.replace('/', '-')}-{run.manifest.run_id[:8]}.zip"
            content = zipped(contents(run.folder))
            archives[run.key] = name, bytes_digest(content)
            write_whole(Path(app.outdir) / DOWNLOADS / name, content)
    downloads = f"{'../' * docname.count('/')}{DOWNLOADS}"
    return filled(
        TEMPLATE, runs=runs, archives=archives, badge=badge, downloads=downloads
    )


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("ledger", Ledger)
