"""Joins the style sheets of the site in one file, without the rules that no page can match.

A phone that fetches one sheet instead of sixteen shows a page earlier.
"""

import re
import tempfile
from collections.abc import Iterable, Mapping
from fnmatch import fnmatch
from pathlib import Path
from urllib.parse import urlsplit

from bs4 import BeautifulSoup

from robo_genesis.core.files import derived_value, write_whole
from robo_genesis.core.project import ROOT
from robo_genesis.pipeline import npm
from robo_genesis.pipeline.command import output_of

OWN = ("print", "calm", "course", "explorer", "replay", "look", "plot", "home", "icons")
THEME = ("basic", "styles/pydata-sphinx-theme", "pygments", "styles/sphinx-book-theme")
EXTENSIONS = ("palette", "togglebutton", "copybutton", "mystnb.*", "sphinx-design.min")

# The sheets of all pages in their order, relative to the site. `math.css` contains a
# font, so only pages with formulas load it.
SHEETS = tuple(f"_static/{name}.css" for name in (*THEME, *EXTENSIONS, *OWN))
# A sheet of the theme that imports the first one and has no rule.
IMPORTING = "_static/styles/theme.css"
# The sheets of the theme and its extensions that have rules for other sites.
TRIMMED = (*SHEETS[:4], *SHEETS[7:9])
JOINED = "_static/styles/site.css"

# Classes and identifiers of a page, which its tags name.
NAMES = re.compile(r' (?:class|id)="([^"]*)"')
WORD = re.compile(r"[\w-]+", re.ASCII)

# A word of a sheet that is neither a class nor an identifier: elements, attributes,
# states.
OTHER_WORD = re.compile(r"(?<![.#\w-])[\w-]+", re.ASCII)
# The beginning of an address that is relative to its sheet.
ADDRESS = re.compile(r"url\(\s*([\"']?)(?![\"']?(?:data:|https?:|[/#]))")
PURGE = "purgecss/bin/purgecss.js"


def link_joined(page: BeautifulSoup) -> None:
    """Replace the links of a page to the single sheets by one link, in place.

    All pages have the same link, so a browser fetches the sheet once. It has no query:
    its content depends on the names in all pages, and a browser asks the server whether
    it changed.
    """
    links = [
        link
        for link in page.find_all("link", rel="stylesheet")
        if _is_joined(str(link["href"]))
    ]
    if links:
        start = str(links[0]["href"]).partition("_static/")[0]
        links[0].attrs = {"rel": "stylesheet", "href": f"{start}{JOINED}"}
        for link in links[1:]:
            link.decompose()


def _is_joined(address: str) -> bool:
    path = urlsplit(address).path
    _, found, name = path.partition("_static/")
    return any(fnmatch(found + name, pattern) for pattern in (*SHEETS, IMPORTING))


def join_sheets(html: Path) -> None:
    """Write the joined sheet of a site.

    The theme's rules with classes or identifiers that the site does not have are left
    out. A name counts as present if a tag of any page has it or if it is a word of any
    script, which may add it later. Rules that name elements and attributes alone stay.

    Args:
        html: folder of the site.

    Raises:
        ProjectError: PurgeCSS failed; the message holds its output.
    """
    sheets = [path for pattern in SHEETS for path in sorted(html.glob(pattern))]
    trimmed = {
        p.name: p.read_text("utf8") for pattern in TRIMMED for p in html.glob(pattern)
    }
    present = used_names(html) | words(trimmed.values(), OTHER_WORD)
    names = "\n".join(sorted(present & words(trimmed.values(), WORD)))
    lock = (ROOT / "package-lock.json").read_text(
        "utf8"
    )  # names the version of PurgeCSS
    found = derived_value(
        "sheets", [names, trimmed, lock], lambda: _purged(trimmed, names)
    )
    joined = html / JOINED
    texts = []
    for path in sheets:
        text = found.get(path.name, path.read_text("utf8"))
        texts.append(
            text if path.parent == joined.parent else ADDRESS.sub(r"url(\1../", text)
        )
    write_whole(joined, "\n".join(texts).encode())


def used_names(html: Path) -> set[str]:
    """Return the classes and identifiers of all pages, and all words of their common scripts."""
    attributes = words((path.read_text("utf8") for path in html.rglob("*.html")), NAMES)
    names = {name for value in attributes for name in value.split()}
    return names | words(
        (path.read_text("utf8") for path in html.glob("_static/**/*.js")), WORD
    )


def words(texts: Iterable[str], pattern: re.Pattern[str]) -> set[str]:
    """Return all matches of a pattern in texts."""
    return {word for text in texts for word in pattern.findall(text)}


def _purged(content: Mapping[str, str], names: str) -> dict[str, str]:
    """Return the sheets without the rules that name none of some words."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in {"names.txt": names, **content}.items():
            (folder / file).write_text(text, "utf8")
        (folder / "out").mkdir()
        command = [str(npm.node()), str(npm.packages() / PURGE), "--keyframes"]
        command += ["--content", "names.txt", "--output", "out", "--css", *content]
        output_of(command, "PurgeCSS failed", cwd=folder)
        return {sheet: (folder / "out" / sheet).read_text("utf8") for sheet in content}
