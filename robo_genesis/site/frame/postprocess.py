"""Changes each written page last: it becomes accessible and loads only the files that it needs."""

import re
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from bs4 import BeautifulSoup
from sphinx.application import Sphinx

from robo_genesis.core import palette
from robo_genesis.core.files import derived
from robo_genesis.site.figures import drawings
from robo_genesis.site.frame import accessibility, style_sheets, weight

CHANGES = (accessibility, drawings, weight, style_sheets, palette)
"""The modules that change a page, and the colours that they use."""
IMAGE = re.compile(r"""<img\b[^>]*?\bsrc="([^"]+)\"""")
"""A picture of a page; a finished page contains its size."""


def note_page(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Note that a page is written in this build; the pages of earlier builds are finished."""
    written(app).add(page)


def written(app: Sphinx) -> set[str]:
    """Return the names of the pages that this build has written so far."""
    pages: set[str] = vars(app.builder).setdefault("robo_genesis_written", set())
    return pages


def finish_site(app: Sphinx, error: Exception | None) -> None:
    """Finish the pages that Sphinx has written."""
    if error is None and app.builder.name == "html":
        weight.drop_unused_files(Path(app.outdir))
        for page in sorted(written(app)):
            path = Path(app.builder.get_outfilename(page))  # type: ignore[attr-defined]
            path.write_text(finish_page(path.read_text("utf8"), path.parent), "utf8")
        style_sheets.join_sheets(Path(app.outdir))  # it looks for the names in all finished pages
    written(app).clear()


def finish_page(html: str, folder: Path) -> str:
    """Return a page as readers get it.

    Args:
        html: the page as the theme wrote it.
        folder: the folder that the page's addresses are relative to.
    """

    def make() -> bytes:
        page = BeautifulSoup(html, "html.parser")
        accessibility.make_accessible(page)
        accessibility.stack_tables(page)
        drawings.inline_drawings(page, folder)
        weight.reduce_weight(page, folder)
        style_sheets.link_joined(page)
        return str(page).encode()

    images = [folder / unquote(urlsplit(unescape(src)).path) for src in IMAGE.findall(html)]
    sources = (Path(module.__file__ or "") for module in CHANGES)
    files = [path for path in (*images, *sources, Path(__file__)) if path.is_file()]
    return derived(
        "finished", [html.encode(), *(path.read_bytes() for path in files)], make
    ).decode()


def setup(app: Sphinx) -> None:
    """Register the extension; see the module's summary."""
    app.connect("html-page-context", note_page)
    # After the theme, which writes the colours of code then.
    app.connect("build-finished", finish_site, priority=900)
