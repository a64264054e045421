"""Several pages of a built site as one document to print: folds open, links inside, no script.

The document stands at the site's root. What a page shows without JavaScript is what is printed.
"""

import posixpath
from collections.abc import Sequence
from html import escape
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

from bs4 import BeautifulSoup, Tag

REFERRING = ("for", "aria-labelledby", "aria-describedby", "aria-controls", "aria-owns")
"""Attributes that name ids, one or several."""

STAYS_ON_SCREEN = "script, template, button, .headerlink"


class ForeignPageError(Exception):
    """A page has no article of this book's theme; the message names it."""


def document(html: Path, docnames: Sequence[str], title: str = "") -> str:
    """Return one HTML document with the articles of some pages, in their order.

    Args:
        html: the folder of the site.
        docnames: pages of it, without suffix.
        title: of the document; by default the first page's heading.

    Raises:
        ForeignPageError: one of them is no page of this book's theme.
    """
    pages = {name: _page(html, name) for name in docnames}
    known = {name: _ids(article) for name, (_, article) in pages.items()}
    styles = _styles(*next(iter(pages.items())))
    for name, (_, article) in pages.items():
        _open(article)
        _follow(article, name, known)
        _rename(article, name)
    articles = "\n".join(str(article) for _, article in pages.values())
    heading = next(iter(pages.values()))[1].find("h1")
    name = title or (heading.get_text(" ", strip=True) if heading else docnames[0])
    return (
        '<!DOCTYPE html>\n<html lang="en" data-theme="light" data-mode="light">\n<head>\n'
        f'<meta charset="utf-8">\n<title>{escape(name)}</title>\n{styles}\n</head>\n'
        f'<body class="printed"><main class="bd-content">\n{articles}\n</main></body>\n</html>\n'
    )


def anchor(docname: str, fragment: str = "") -> str:
    """Return the id that a page, or a place on it, has in a document of several pages."""
    return f"{docname.replace('/', '-')}{f'--{fragment}' if fragment else ''}"


def _page(html: Path, docname: str) -> tuple[BeautifulSoup, Tag]:
    page = BeautifulSoup((html / f"{docname}.html").read_text("utf8"), "html.parser")
    article = page.select_one("article.bd-article")
    if article is None:
        raise ForeignPageError(f"{docname}.html has no article: no page of this book's theme.")
    return page, article


def _ids(article: Tag) -> set[str]:
    return {str(tag["id"]) for tag in article.find_all(id=True)}


def _styles(docname: str, page: tuple[BeautifulSoup, Tag]) -> str:
    """Return the page's style sheets, with addresses from the root."""
    links = page[0].select("head link[rel=stylesheet], head style")
    for link in links:
        if link.has_attr("href"):
            link["href"] = _from_root(docname, str(link["href"]))
    return "\n".join(str(link) for link in links)


def _from_root(docname: str, url: str) -> str:
    """Return an address on a page as an address at the root; one elsewhere stays."""
    if urlsplit(url).scheme or url.startswith("//"):
        return url
    return posixpath.normpath(posixpath.join(posixpath.dirname(docname), url))


def _open(article: Tag) -> None:
    """Open folds, take out what only a screen has, and load pictures at once."""
    for tag in article.select(STAYS_ON_SCREEN):
        tag.decompose()
    for tag in article.find_all("noscript"):
        tag.unwrap()
    for tag in article.find_all("details"):
        tag["open"] = ""
    for tag in article.find_all(loading=True):
        del tag["loading"]


def _follow(article: Tag, docname: str, known: dict[str, set[str]]) -> None:
    """Lead links to where their target is printed; one to what is not printed becomes text."""
    for tag in article.find_all(src=True):
        tag["src"] = _from_root(docname, str(tag["src"]))
    for tag in article.find_all("a", href=True):
        url = str(tag["href"])
        if urlsplit(url).scheme:
            continue
        address, fragment = urldefrag(_from_root(docname, url))
        target = unquote(address).removesuffix(".html") if address not in ("", ".") else docname
        if url.startswith("#"):
            target = docname
        fragment = unquote(fragment)
        if target in known:
            tag["href"] = f"#{anchor(target, fragment if fragment in known[target] else '')}"
        else:
            del tag["href"]


def _rename(article: Tag, docname: str) -> None:
    """Make the ids of a page unlike those of all other pages."""
    for tag in article.find_all(id=True):
        tag["id"] = anchor(docname, str(tag["id"]))
    for name in REFERRING:
        for tag in article.find_all(attrs={name: True}):
            tag[name] = " ".join(anchor(docname, part) for part in str(tag[name]).split())
    for tag in article.select("input[name]"):
        tag["name"] = anchor(docname, str(tag["name"]))
    article["id"] = anchor(docname)
