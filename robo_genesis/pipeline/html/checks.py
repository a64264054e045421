"""Checks on the built site that need no browser: links, alt texts, scripts, leftovers."""

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote, urldefrag, urlsplit

from bs4 import BeautifulSoup, Tag

from robo_genesis.core.files import derived_value
from robo_genesis.pipeline.html import scripts

ADDRESSES = {"href", "src", "srcset", "poster", "data", "action"}
# A link of these kinds names a page for readers or crawlers; the browser does not load
# it.
NOT_LOADED = {
    "canonical",
    "alternate",
    "author",
    "license",
    "next",
    "prev",
    "index",
    "search",
}
ELSEWHERE = re.compile(r"^(?:https?|wss?|ftp):|^//", re.IGNORECASE)
CSS_ADDRESS = re.compile(
    r"""(?:(?:@import\s+)?url\(|@import)\s*["']?([^"')\s;]+)""", re.IGNORECASE
)
CSS_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
SCRIPT_ADDRESS = re.compile(
    r"""["'`]((?:https?:)?//[\w.-]+\.[a-z]{2,}[^"'`]*)""", re.IGNORECASE
)
SERVICES = re.compile(
    r"unpkg\.com|jsdelivr\.net|cdnjs\.|googleapis\.com|gstatic\.com|polyfill\.io|mybinder\.org",
    re.IGNORECASE,
)
FILE_NAME = re.compile(
    r"^\S*\.(?:png|jpe?g|svg|webp|gif)$|^[0-9a-f]{16,}$", re.IGNORECASE
)

# Classes of elements that quote bundles, whose text no markup of a page makes.
QUOTING = ["evidence-panel", "run-block", "lesson-status", "measured"]
LEFTOVERS = re.compile(
    r"\{[a-z][a-z:_-]*\}(?=`|\()|\\[\[\(]|\$\$|\[\[[^\]]*\]\]|<Figure size "
)


@dataclass(frozen=True, slots=True)
class SiteCheck:
    """One check: how many things it examined, and a line for each problem."""

    name: str
    count: int
    problems: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PageFacts:
    """What the checks use of one page; a page is parsed again only when it or a check changed.

    `addresses` are those of links and files, `loaded` those that a browser asks for by
    itself. `examined` and `problems` have, by the name of a check that needs no other
    page, how many things it examined, and whole lines without the name of the page.
    """

    anchors: list[str]
    addresses: list[str]
    loaded: list[str]
    examined: dict[str, int]
    problems: dict[str, list[str]]


class Site:
    """The files of a built site, and the facts of each page."""

    def __init__(self, html: Path, base: str = "/"):
        """Read the pages.

        Args:
            html: the folder with the site's `index.html`.
            base: the path that this folder will have on its server, with a slash at
                both ends.
        """
        self.root, self.base = html.resolve(), base
        self.files: dict[str, Path | None] = {}
        self.pages = {
            path: self._facts(path) for path in sorted(self.root.rglob("*.html"))
        }
        self.anchors = {path: set(page.anchors) for path, page in self.pages.items()}
        self.in_style_sheets = [
            (path, url)
            for path in sorted(self.root.rglob("*.css"))
            for url in _in_style(path.read_text("utf8"))
        ]

    def _facts(self, path: Path) -> PageFacts:
        text = path.read_text("utf8")
        inputs = [
            text,
            self.name(path),
            self.base,
            Path(scripts.__file__).read_text("utf8"),
        ]

        def make() -> dict[str, Any]:
            parsed = BeautifulSoup(text, "html.parser")
            return asdict(
                page_facts(scripts.Page(self.root, self.base, path, parsed, text))
            )

        return PageFacts(**derived_value("checked", inputs, make))

    def file(self, folder: Path, place: str) -> Path | None:
        """Return the file at a place relative to a folder, None if the site has no such file."""
        named = os.path.normpath(folder / place)
        if named not in self.files:
            found = Path(named).resolve()
            found = found / "index.html" if found.is_dir() else found
            inside = found.is_relative_to(self.root) and found.is_file()
            self.files[named] = found if inside else None
        return self.files[named]

    def name(self, path: Path) -> str:
        """Return a file's name for messages."""
        return path.relative_to(self.root).as_posix()


def page_facts(page: scripts.Page) -> PageFacts:
    """Return what the checks use of a page."""
    tags = page.parsed.find_all(True)
    names = (tag.get(name) for tag in tags for name in ("id", "name"))
    style = [tag.get_text() for tag in tags if tag.name == "style"]
    style += [str(tag["style"]) for tag in tags if tag.has_attr("style")]
    inline = page.parsed.find_all("script", src=False)
    found = [(url, _is_loaded(tag)) for tag in tags for url in _addresses(tag)]
    found += [(url, True) for text in style for url in _in_style(text)]
    in_scripts = [
        url for tag in inline for url in SCRIPT_ADDRESS.findall(tag.get_text())
    ]
    images = _images(page.parsed)
    return PageFacts(
        anchors=sorted({str(name) for name in names if name}),
        addresses=[url for url, _ in found],
        loaded=[url for url, is_loaded in found if is_loaded] + in_scripts,
        examined={
            "alt texts": len(images),
            "scripts": len(page.parsed.find_all("script")),
            "leftovers": 1,
        },
        problems={
            "alt texts": list(_alt_problems(images)),
            "scripts": sorted(set(scripts.page_problems(page))),
            "leftovers": list(_leftovers(page.parsed)),
        },
    )


def run_checks(site: Site) -> list[SiteCheck]:
    """Run all checks on a site whose pages were read.

    | check | requirement |
    |---|---|
    | links | each address inside the site leads to a file, each fragment to an element |
    | alt texts | each image has a text that is neither empty nor a file name nor a hash |
    | third parties | nothing is loaded from another address; readers may follow links |
    | scripts | the site runs the scripts of the theme and of the course only; see `scripts` |
    | leftovers | no page shows unprocessed markup, or an error of the page generator |
    """
    return [
        check_links(site),
        _of_pages(site, "alt texts"),
        check_third_parties(site),
        _of_pages(site, "scripts", scripts.file_problems(site.root)),
        _of_pages(site, "leftovers"),
    ]


def _of_pages(site: Site, check: str, more: Iterable[str] = ()) -> SiteCheck:
    """Return a check that was made page by page, with further problems."""
    pages = site.pages.items()
    problems = [
        f"{site.name(path)}: {line}"
        for path, page in pages
        for line in page.problems[check]
    ]
    return SiteCheck(
        check, sum(page.examined[check] for _, page in pages), (*problems, *more)
    )


def check_links(site: Site) -> SiteCheck:
    """Check that every address inside the site leads to a file or an element."""
    found = [(path, url) for path, page in site.pages.items() for url in page.addresses]
    found += site.in_style_sheets
    inside = [
        (path, url)
        for path, url in found
        if not urlsplit(url).scheme and url[:2] != "//"
    ]
    problems = {
        f"{site.name(path)}: {url!r} {reason}"
        for path, url in dict.fromkeys(inside)
        if (reason := _broken(site, path, url))
    }
    return SiteCheck("links", len(inside), tuple(sorted(problems)))


def _broken(site: Site, page: Path, url: str) -> str | None:
    """Return why an address inside the site leads nowhere."""
    address, fragment = urldefrag(url)
    place = unquote(urlsplit(address).path)
    if place.startswith("/") and not place.startswith(site.base):
        return f"leads out of {site.base}, the path of the site."
    base = site.root if place.startswith("/") else page.parent
    target = site.file(base, place.removeprefix(site.base)) if place else page
    if target is None:
        return "leads to no file of the site."
    known = site.anchors.get(target)
    if (
        fragment
        and fragment != "top"
        and known is not None
        and unquote(fragment) not in known
    ):
        return f"names no element of {site.name(target)}."
    return None


def check_third_parties(site: Site) -> SiteCheck:
    """Check that nothing is loaded from another address."""
    found = [(path, url) for path, page in site.pages.items() for url in page.loaded]
    found += site.in_style_sheets + _services(site)
    problems = sorted(
        {f"{site.name(path)}: {url}" for path, url in found if ELSEWHERE.match(url)}
    )
    return SiteCheck("third parties", len(found), tuple(problems))


def _images(page: BeautifulSoup) -> list[Tag]:
    """Return a page's images and drawings."""
    return [*page.find_all("img"), *page.find_all("svg", class_="drawing")]


def _alt_problems(images: Iterable[Tag]) -> Iterator[str]:
    for image in images:
        names = ("alt", "src") if image.name == "img" else ("aria-label", "data-file")
        text, source = (str(image.get(name) or "").strip() for name in names)
        if (
            not text
            or FILE_NAME.match(text)
            or text == PurePosixPath(urlsplit(source).path).stem
        ):
            yield f"{source} has the alt text {text!r}."


def _leftovers(page: BeautifulSoup) -> Iterator[str]:
    for tag in page.find_all(class_=["system-message", "problematic"]):
        yield repr(tag.get_text(" ", strip=True)[:80])
    article = page.find("article")
    for text in (article if isinstance(article, Tag) else page).find_all(
        string=LEFTOVERS
    ):
        quoted = text.find_parent(["pre", "code", "script", "style"])
        if not (quoted or text.find_parent(class_=QUOTING)):
            yield repr(text.strip()[:80])


def _addresses(tag: Tag) -> Iterator[str]:
    """Yield every address that an element carries."""
    for name in tag.attrs.keys() & ADDRESSES:
        value = str(tag.get(name) or "").strip()
        listed = (
            [part.split()[:1] for part in value.split(",")]
            if name == "srcset"
            else [[value]]
        )
        yield from (url for urls in listed for url in urls if url)


def _is_loaded(tag: Tag) -> bool:
    """Whether the browser itself asks for the element's address."""
    kinds = {str(kind).lower() for kind in tag.get("rel") or []}
    return tag.name not in ("a", "area") and not (
        tag.name == "link" and kinds & NOT_LOADED
    )


def _in_style(text: str) -> list[str]:
    """Return the addresses in a style sheet, style element or style attribute."""
    return [
        url for url in CSS_ADDRESS.findall(CSS_COMMENT.sub("", text)) if url[:1] != "#"
    ]


def _services(site: Site) -> list[tuple[Path, str]]:
    """Return the addresses of known services in script files.

    Script files of the theme contain addresses in licence notes and messages, and their
    text does not show which ones they load; so files are searched for the usual
    services only.
    """
    return [
        (path, url)
        for path in sorted(site.root.rglob("*.js"))
        if path.name != "searchindex.js"
        for url in SCRIPT_ADDRESS.findall(path.read_text("utf8", errors="replace"))
        if SERVICES.search(url)
    ]
