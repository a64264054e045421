"""Parts that depend on the site's address: canonical links, sitemap, social cards, the 404 page.

A site without an address has no canonical link, no sitemap and no card. The 404 page is
always written; a server shows it at any depth, so its links begin at the site's root.
"""

from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.config import Config

from robo_genesis.core.markup import filled
from robo_genesis.pipeline.html.address import site_address, site_root

# Pages that the 404 page links to, where a book has them.
WAYS_ON = {
    "index": "the course map: every lesson, published and planned",
    "glossary": "the words of the field",
    "evidence/index": "from a measured number to its run",
}


def configure(app: Sphinx, config: Config) -> None:
    """Give the site's address to Sphinx and the extensions."""
    config.notfound_urls_prefix = site_root()
    if address := site_address():
        config.html_baseurl = config.ogp_site_url = address
        config.sitemap_url_scheme, config.sitemap_locales = "{link}", [None]
        config.sitemap_excludes = ["404.html", "search.html", "genindex.html"]


def write_not_found(app: Sphinx) -> list[Any]:
    """Write the text of the 404 page when the pages of the book are known."""
    root, titles = site_root(), app.env.titles
    ways = [
        (page, titles[page].astext(), what)
        for page, what in WAYS_ON.items()
        if page in titles
    ]
    body = filled(Path(__file__).with_name("not_found.html"), root=root, ways=ways)
    app.config.notfound_context = {"title": "Page not found", "body": body}
    return []


def setup(app: Sphinx) -> None:
    """Register the 404 page, and the extensions that need an address if there is one.

    Raises:
        ProjectError: the given address is not valid.
    """
    app.setup_extension("notfound.extension")
    if site_address():
        app.setup_extension("sphinx_sitemap")
        app.setup_extension("sphinxext.opengraph")
    app.connect(
        "config-inited", configure, priority=400
    )  # notfound checks the prefix at 500
    app.connect(
        "html-collect-pages", write_not_found, priority=400
    )  # and collects its page at 500
