"""What depends on where the site will stand: canonical links, sitemap, social cards, and the 404 page.

The address is the environment variable `SITE_URL`, as in `make book SITE_URL=https://example.org/course/`.
Without it nothing claims an address: no canonical link, no sitemap, no cards. The 404 page is there always; a
server shows it at any depth, so its links begin at the site's root.
"""

import os
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.errors import ConfigError

from robo_genesis import social_card
from robo_genesis.sphinx_evidence import outputs_folder

SITE_URL = "SITE_URL"
CARD = "_static/social-card.png"
CARD_ALT = "Measured positions of a robot's joint over time, three cases, one with overshoot."
NOT_FOUND = """\
<h1>There is no such page</h1>
<p>The address may be mistyped, or what stood here has moved. Each published heading keeps its anchor, so a link
to a page's part still works once the page's own address is right.</p>
<form class="lost" role="search" action="{root}search.html" method="get">
<label for="lost-words">Search this course</label>
<input id="lost-words" type="search" name="q" autocomplete="off"/>
<button type="submit">Search</button>
</form>
<ul>
<li><a href="{root}index.html#course-map">Course map</a>: every lesson, published and planned</li>
<li><a href="{root}glossary.html">Glossary</a>: the words of the field</li>
<li><a href="{root}evidence/ledger.html">Ledger</a>: every figure, table and run</li>
</ul>
"""


def site_address(given: str | None) -> str | None:
    """Return the site's address with a slash at its end, None where none is given.

    Raises:
        ConfigError: it is no address of the web, or has a query or a fragment.
    """
    if not given:
        return None
    parts = urlsplit(given)
    if parts.scheme not in ("http", "https") or not parts.netloc or parts.query or parts.fragment:
        raise ConfigError(
            f"{SITE_URL} is {given!r}; valid is an address as https://example.org/course/."
        )
    return given.rstrip("/") + "/"


def configure(app: Sphinx, config: Config) -> None:
    """Tell Sphinx and the extensions where the site will stand."""
    address = site_address(os.environ.get(SITE_URL))
    root = urlsplit(address).path if address else "/"
    config.notfound_urls_prefix = root
    config.notfound_context = {"title": "Page not found", "body": NOT_FOUND.format(root=root)}
    if address is None:
        return
    config.html_baseurl = config.ogp_site_url = address
    config.sitemap_url_scheme = "{link}"
    config.sitemap_locales = [None]
    config.sitemap_excludes = ["404.html", "search.html", "genindex.html"]
    config.ogp_image, config.ogp_image_alt = address + CARD, CARD_ALT
    config.ogp_enable_meta_description = True
    app.connect("build-finished", draw_card)


def draw_card(app: Sphinx, failure: Exception | None) -> None:
    """Draw the card that a link to the site shows elsewhere, from this build's lab."""
    if failure is None:
        file = Path(app.outdir) / CARD
        file.write_bytes(social_card.card(outputs_folder() / "l04" / "lab" / "cpu"))


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the 404 page, and with an address what needs one."""
    app.setup_extension("notfound.extension")
    if os.environ.get(SITE_URL):
        app.setup_extension("sphinx_sitemap")
        app.setup_extension("sphinxext.opengraph")
    app.connect("config-inited", configure, priority=400)  # notfound checks the prefix at 500
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
