"""Checks on the built site that need no browser: links, alt texts, hosts, leftovers, paths."""

import os
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urldefrag, urlsplit

from robo_genesis.core.project import ROOT

# Each page has this policy: the browser itself then loads nothing from another host.
# `file:` is for a site that is read from disk; the viewer of the replays compiles
# WebAssembly.
POLICY_NAME = "Content-Security-Policy"
POLICY = "default-src 'self' file: data: blob: 'unsafe-inline' 'unsafe-eval'"

ADDRESSES = {"href", "src", "srcset", "poster", "data", "action"}
# Links of these kinds name a page for readers or crawlers; no browser loads it.
NOT_LOADED = {"canonical", "alternate", "author", "license", "next", "prev", "search"}
ELSEWHERE = re.compile(r"(?:https?|wss?|ftp):|//", re.IGNORECASE)
FILE_NAME = re.compile(
    r"^\S*\.(?:png|jpe?g|svg|webp|gif)$|^[0-9a-f]{16,}$", re.IGNORECASE
)
PRIVATE = (str(Path.home()), str(ROOT))  # No published file names them
QUOTING = ("pre", "code", "script", "style")
LEFTOVERS = re.compile(
    r"\{[a-z][a-z:_-]*\}(?=`|\()|\\[\[\(]|\$\$|\[\[[^\]]*\]\]|<Figure size "
)


@dataclass(frozen=True, slots=True)
class SiteCheck:
    """One check: how many things it examined, and a line for each problem."""

    name: str
    count: int
    problems: tuple[str, ...]


class PageReader(HTMLParser):
    """Collects what the checks use of one page."""

    def __init__(self, text: str) -> None:
        """Read a page.

        Args:
            text: its HTML.
        """
        super().__init__()
        self.anchors: list[str] = []
        self.addresses: list[str] = []
        self.loaded: list[str] = []
        self.alt_texts: list[tuple[str, str]] = []
        self.texts: list[str] = []
        self.policies: list[str | None] = []
        self.quotes = 0
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note anchors, addresses and the text of an image."""
        given = {name: value or "" for name, value in attrs}
        self.quotes += tag in QUOTING
        if identifier := given.get("id"):
            self.anchors.append(identifier)
        found = [url for name in ADDRESSES & given.keys() for url in urls(name, given)]
        self.addresses += found
        kinds = {*given.get("rel", "").lower().split()}
        if tag not in ("a", "area") and not (tag == "link" and kinds & NOT_LOADED):
            self.loaded += found
        if tag == "img":
            self.alt_texts.append((given.get("alt", ""), given.get("src", "")))
        if tag == "svg" and "drawing" in given.get("class", "").split():
            source = given.get("data-file", "")
            self.alt_texts.append((given.get("aria-label", ""), source))
        if given.get("http-equiv") == POLICY_NAME:
            self.policies.append(given.get("content"))

    def handle_endtag(self, tag: str) -> None:
        """Note the end of quoted text."""
        self.quotes -= tag in QUOTING

    def handle_data(self, data: str) -> None:
        """Note the text that a reader sees as prose."""
        if not self.quotes:
            self.texts.append(data)


def urls(name: str, attributes: dict[str, str]) -> list[str]:
    """Return the addresses that an attribute of an element lists."""
    value = attributes[name].strip()
    if name == "srcset":
        return [part.split()[0] for part in value.split(",") if part.strip()]
    return [value] if value else []


class Site:
    """The pages of a built site by path, as they were read.

    `base` is the path that the folder will have on its server, with a slash at both
    ends.
    """

    def __init__(self, html: Path, base: str = "/") -> None:
        self.root, self.base = html.resolve(), base
        self.pages = {
            path: PageReader(path.read_text("utf8"))
            for path in sorted(self.root.rglob("*.html"))
        }

    def name(self, path: Path) -> str:
        """Return a file's name for messages."""
        return path.relative_to(self.root).as_posix()


def _broken_links(site: Site, path: Path, page: PageReader) -> Iterator[str]:
    for address in page.addresses:
        parts = urlsplit(address)
        if not (parts.scheme or parts.netloc) and (why := _broken(site, path, address)):
            yield f"{address!r} {why}"


def _broken(site: Site, page: Path, address: str) -> str | None:
    """Return why an address inside the site names no file, as a site on disk needs."""
    address, fragment = urldefrag(address)
    place = unquote(urlsplit(address).path)
    if place.startswith("/") and not place.startswith(site.base):
        return f"leads out of {site.base}, the path of the site."
    folder = site.root if place.startswith("/") else page.parent
    target = page
    if place:
        target = Path(os.path.normpath(folder / place.removeprefix(site.base)))
    if not (target.is_relative_to(site.root) and target.is_file()):
        return "leads to no file of the site."
    known = site.pages.get(target)
    if fragment in ("", "top") or known is None or unquote(fragment) in known.anchors:
        return None
    return f"names no element of {site.name(target)}."


def _repeated_anchors(site: Site, path: Path, page: PageReader) -> Iterator[str]:
    seen: set[str] = set()
    for anchor in page.anchors:
        if anchor in seen:
            yield f"two elements have the id {anchor!r}."
        seen.add(anchor)


def _bad_alt_texts(site: Site, path: Path, page: PageReader) -> Iterator[str]:
    for text, source in page.alt_texts:
        stem = PurePosixPath(urlsplit(source).path).stem
        if not text.strip() or FILE_NAME.match(text) or text == stem:
            yield f"{source} has the alt text {text!r}."


def _foreign(site: Site, path: Path, page: PageReader) -> Iterator[str]:
    if POLICY not in page.policies:
        yield f"has no {POLICY_NAME} {POLICY!r}."
    yield from filter(ELSEWHERE.match, page.loaded)


def _leftovers(site: Site, path: Path, page: PageReader) -> Iterator[str]:
    for text in page.texts:
        if LEFTOVERS.search(text):
            yield repr(text.strip()[:80])


# By its name, what a check examines on a page, and what finds the problems.
CHECKS: dict[str, tuple[str, Callable[[Site, Path, PageReader], Iterator[str]]]] = {
    "links": ("addresses", _broken_links),
    "anchors": ("anchors", _repeated_anchors),
    "alt texts": ("alt_texts", _bad_alt_texts),
    "third parties": ("loaded", _foreign),
    "leftovers": ("texts", _leftovers),
}


def run_checks(site: Site) -> list[SiteCheck]:
    """Run all checks on a site.

    | check | requirement |
    |---|---|
    | links | each address inside the site leads to a file, each fragment to an element |
    | anchors | no two elements of a page have one id |
    | alt texts | each image has a text that is neither empty nor a file name nor a hash |
    | third parties | nothing is loaded from another host; readers may follow links |
    | leftovers | no page shows unprocessed markup |
    | private paths | no published file names the builder's home or checkout |
    """
    checks = [private_paths(site.root.parent)]
    for name, (examined, find) in CHECKS.items():
        problems = [
            f"{site.name(path)}: {problem}"
            for path, page in site.pages.items()
            for problem in dict.fromkeys(find(site, path, page))
        ]
        count = sum(len(getattr(page, examined)) for page in site.pages.values())
        checks.append(SiteCheck(name, count, tuple(problems)))
    return checks


def private_paths(published: Path) -> SiteCheck:
    """Check that no published file names the home folder or the checkout of the builder.

    Args:
        published: the folder of the site and its bundles.
    """
    private = re.compile(
        rb"(?<![\w./-])(?:%s)/" % b"|".join(re.escape(os.fsencode(p)) for p in PRIVATE)
    )
    files = [path for path in published.rglob("*") if path.is_file()]
    problems = [
        f"{path.relative_to(published).as_posix()}: names {match[0].decode()}"
        for path in files
        if (match := private.search(path.read_bytes()))
    ]
    return SiteCheck("private paths", len(files), tuple(problems))
