"""The last touch on each written page: accessible and light, whatever the theme wrote."""

from pathlib import Path
from typing import Any

from bs4 import BeautifulSoup
from sphinx.application import Sphinx

from robo_genesis.site.accessibility import mend
from robo_genesis.site.page_weight import drop_unused_files, lighten


def finish_site(app: Sphinx, error: Exception | None) -> None:
    """Mend and lighten all pages of a site that Sphinx has written."""
    if error is None and app.builder.name == "html":
        html = Path(app.outdir)
        drop_unused_files(html)
        for path in html.rglob("*.html"):
            path.write_text(finished(path.read_text("utf8"), path.parent), "utf8")


def finished(html: str, folder: Path) -> str:
    """Return a page as readers get it.

    Args:
        html: the page as the theme wrote it.
        folder: the folder that the page's addresses are relative to.
    """
    page = BeautifulSoup(html, "html.parser")
    mend(page)
    lighten(page, folder)
    return str(page)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension; see the module's summary."""
    app.connect("build-finished", finish_site)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
