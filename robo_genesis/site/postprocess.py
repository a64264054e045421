"""Changes each written page last: it becomes accessible and loads only the files that it needs."""

from pathlib import Path

from bs4 import BeautifulSoup
from sphinx.application import Sphinx

from robo_genesis.site.accessibility import make_accessible
from robo_genesis.site.page_weight import drop_unused_files, reduce_weight


def finish_site(app: Sphinx, error: Exception | None) -> None:
    """Finish all pages of a site that Sphinx has written."""
    if error is None and app.builder.name == "html":
        html = Path(app.outdir)
        drop_unused_files(html)
        for path in html.rglob("*.html"):
            path.write_text(finish_page(path.read_text("utf8"), path.parent), "utf8")


def finish_page(html: str, folder: Path) -> str:
    """Return a page as readers get it.

    Args:
        html: the page as the theme wrote it.
        folder: the folder that the page's addresses are relative to.
    """
    page = BeautifulSoup(html, "html.parser")
    make_accessible(page)
    reduce_weight(page, folder)
    return str(page)


def setup(app: Sphinx) -> None:
    """Register the extension; see the module's summary."""
    app.connect("build-finished", finish_site)
