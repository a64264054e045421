"""What depends on where the site will stand: canonical links, sitemap, social cards, the 404 page.

Without an address (see `address`) nothing claims one: no canonical link, no sitemap, no card. The
404 page is always there; a server shows it at any depth, so its links begin at the site's root.
"""

from html import escape
from typing import Any

from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.errors import ConfigError

from robo_genesis.build.site_address import AddressError, site_address, site_root

NOT_FOUND = """\
<h1>There is no such page</h1>
<p>The address may be mistyped, or what stood here has moved. Search, or start from one of the
pages below.</p>
<form class="lost" role="search" action="{root}search.html" method="get">
<label for="lost-words">Search all pages</label>
<input id="lost-words" type="search" name="q" autocomplete="off"/>
<button type="submit">Search</button>
</form>
<ul>{links}</ul>
"""
WAYS_ON = {
    "index": "the course map: every lesson, published and planned",
    "glossary": "the words of the field",
    "evidence/ledger": "every figure, table and run",
}
"""Pages that the 404 page leads to, where a book has them."""


def configure(app: Sphinx, config: Config) -> None:
    """Tell Sphinx and the extensions where the site will stand."""
    config.notfound_urls_prefix = site_root()
    address = site_address()
    if address is None:
        return
    config.html_baseurl = config.ogp_site_url = address
    config.sitemap_url_scheme = "{link}"
    config.sitemap_locales = [None]
    config.sitemap_excludes = ["404.html", "search.html", "genindex.html"]


def write_not_found(app: Sphinx) -> list[Any]:
    """Write the 404 page's text, once it is known which pages the book has."""
    root, titles = site_root(), app.env.titles
    links = "".join(
        f'<li><a href="{root}{page}.html">{escape(titles[page].astext())}</a>: {what}</li>'
        for page, what in WAYS_ON.items()
        if page in titles
    )
    body = NOT_FOUND.format(root=root, links=links)
    app.config.notfound_context = {"title": "Page not found", "body": body}
    return []


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the 404 page, and with an address what needs one.

    Raises:
        ConfigError: the address is none.
    """
    app.setup_extension("notfound.extension")
    try:
        address = site_address()
    except AddressError as error:
        raise ConfigError(str(error)) from error
    if address:
        app.setup_extension("sphinx_sitemap")
        app.setup_extension("sphinxext.opengraph")
    app.connect("config-inited", configure, priority=400)  # notfound checks the prefix at 500
    app.connect("html-collect-pages", write_not_found, priority=400)  # and collects its page at 500
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
