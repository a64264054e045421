"""Checks on the built site that need no browser: links, alt texts, third parties, leftovers."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urldefrag, urlsplit

from bs4 import BeautifulSoup, Tag

ADDRESSES = {"href", "src", "srcset", "poster", "data", "action"}
# A link of these kinds names a page for readers or crawlers; the browser does not load it.
NOT_LOADED = {"canonical", "alternate", "author", "license", "next", "prev", "index", "search"}
ELSEWHERE = re.compile(r"^(?:https?|wss?|ftp):|^//", re.IGNORECASE)
CSS_ADDRESS = re.compile(r"""(?:(?:@import\s+)?url\(|@import)\s*["']?([^"')\s;]+)""", re.IGNORECASE)
CSS_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
SCRIPT_ADDRESS = re.compile(r"""["'`]((?:https?:)?//[\w.-]+\.[a-z]{2,}[^"'`]*)""", re.IGNORECASE)
SERVICES = re.compile(
    r"unpkg\.com|jsdelivr\.net|cdnjs\.|googleapis\.com|gstatic\.com|polyfill\.io|mybinder\.org",
    re.IGNORECASE,
)
FILE_NAME = re.compile(r"^\S*\.(?:png|jpe?g|svg|webp|gif)$|^[0-9a-f]{16,}$", re.IGNORECASE)
LEFTOVERS = re.compile(r"\{[a-z][a-z:_-]*\}(?=`|\()|\\[\[\(]|\$\$|\[\[[^\]]*\]\]|<Figure size ")


@dataclass(frozen=True, slots=True)
class SiteCheck:
    """One check: how many things it looked at, and a line for each that is wrong."""

    name: str
    count: int
    problems: tuple[str, ...]


class Site:
    """The files of a built site, each page parsed and walked once."""

    def __init__(self, html: Path, base: str = "/"):
        self.root, self.base = html.resolve(), base
        self.pages = {
            path: BeautifulSoup(path.read_text("utf8"), "html.parser")
            for path in sorted(self.root.rglob("*.html"))
        }
        self.anchors: dict[Path, set[str]] = {}
        self.addresses: dict[Path, list[tuple[Tag, str]]] = {}
        self.styled: dict[Path, list[Tag]] = {}
        for path, page in self.pages.items():
            tags = page.find_all(True)
            self.anchors[path] = set(_anchors(tags))
            self.addresses[path] = list(_addresses(tags))
            self.styled[path] = [tag for tag in tags if tag.has_attr("style")]

    def name(self, path: Path) -> str:
        """Return a file's name for messages."""
        return path.relative_to(self.root).as_posix()


def check_site(html: Path, base: str = "/") -> list[SiteCheck]:
    """Run all checks on a built site.

    Args:
        html: the folder with the site's `index.html`.
        base: the path that this folder will have on its server, with a slash at both ends.
    """
    site = Site(html, base)
    checks = (check_links, check_alt_texts, check_third_parties, check_leftovers)
    return [check(site) for check in checks]


def check_links(site: Site) -> SiteCheck:
    """Every address inside the site leads to a file, and every fragment to an element."""
    found = [(path, url) for path, listed in site.addresses.items() for _, url in listed]
    found += _style_addresses(site)
    inside = [(path, url) for path, url in found if not urlsplit(url).scheme and url[:2] != "//"]
    problems = {
        f"{site.name(path)}: {url!r} {reason}"
        for path, url in inside
        if (reason := _broken(site, path, url))
    }
    return SiteCheck("links", len(inside), tuple(sorted(problems)))


def _broken(site: Site, page: Path, url: str) -> str | None:
    """Return why an address inside the site leads nowhere."""
    address, fragment = urldefrag(url)
    place = unquote(urlsplit(address).path)
    if place.startswith("/") and not place.startswith(site.base):
        return f"leads out of {site.base}, where the site will stand."
    base = site.root if place.startswith("/") else page.parent
    target = (base / place.removeprefix(site.base)).resolve() if place else page
    target = target / "index.html" if target.is_dir() else target
    if not target.is_relative_to(site.root) or not target.is_file():
        return "leads to no file of the site."
    known = site.anchors.get(target)
    if fragment and fragment != "top" and known is not None and unquote(fragment) not in known:
        return f"names no element of {site.name(target)}."
    return None


def check_alt_texts(site: Site) -> SiteCheck:
    """Every image has an alternative text that says something: no file name, no hash."""
    images = [(path, image) for path, page in site.pages.items() for image in page.find_all("img")]
    problems = [
        f"{site.name(path)}: {image.get('src')} has the alt text {image.get('alt')!r}."
        for path, image in images
        if not _speaks(str(image.get("alt") or ""), str(image.get("src") or ""))
    ]
    return SiteCheck("alt texts", len(images), tuple(problems))


def _speaks(text: str, source: str) -> bool:
    text = text.strip()
    stem = PurePosixPath(urlsplit(source).path).stem
    return bool(text) and not FILE_NAME.match(text) and text != stem


def check_third_parties(site: Site) -> SiteCheck:
    """Nothing is loaded from another address; links that a reader may follow are fine."""
    found = [
        (path, url)
        for path, listed in site.addresses.items()
        for tag, url in listed
        if _is_loaded(tag)
    ]
    found += _style_addresses(site)
    found += _script_addresses(site)
    problems = sorted({f"{site.name(path)}: {url}" for path, url in found if ELSEWHERE.match(url)})
    return SiteCheck("third parties", len(found), tuple(problems))


def check_leftovers(site: Site) -> SiteCheck:
    """No page shows markup that was not understood, or an error of the page generator."""
    problems: list[str] = []
    for path, page in site.pages.items():
        found = [
            tag.get_text(" ", strip=True) for tag in page.select(".system-message, .problematic")
        ]
        found += [
            text.strip()
            for text in (page.select_one("article") or page).find_all(string=LEFTOVERS)
            if not text.find_parent(["pre", "code", "script", "style"])
        ]
        problems += [f"{site.name(path)}: {text[:80]!r}" for text in found]
    return SiteCheck("leftovers", len(site.pages), tuple(problems))


def _anchors(tags: Iterable[Tag]) -> Iterator[str]:
    for tag in tags:
        yield from (str(tag[name]) for name in ("id", "name") if tag.get(name))


def _addresses(tags: Iterable[Tag]) -> Iterator[tuple[Tag, str]]:
    """Yield every address that elements carry."""
    for tag in tags:
        for name in tag.attrs.keys() & ADDRESSES:
            value = str(tag.get(name) or "").strip()
            for url in _listed(value) if name == "srcset" else [value]:
                if url:
                    yield tag, url


def _listed(srcset: str) -> list[str]:
    return [part.split()[0] for part in srcset.split(",") if part.split()]


def _is_loaded(tag: Tag) -> bool:
    """Whether the browser itself asks for the element's address."""
    kinds = {str(kind).lower() for kind in tag.get("rel") or []}
    return tag.name not in ("a", "area") and not (tag.name == "link" and kinds & NOT_LOADED)


def _style_addresses(site: Site) -> list[tuple[Path, str]]:
    """Return the addresses in style sheets, style elements and style attributes."""
    texts = [(path, path.read_text("utf8")) for path in sorted(site.root.rglob("*.css"))]
    for path, page in site.pages.items():
        texts += [(path, tag.get_text()) for tag in page.find_all("style")]
        texts += [(path, str(tag["style"])) for tag in site.styled[path]]
    return [(path, url) for path, text in texts for url in _in_style(text)]


def _in_style(text: str) -> Iterable[str]:
    return (url for url in CSS_ADDRESS.findall(CSS_COMMENT.sub("", text)) if url[:1] != "#")


def _script_addresses(site: Site) -> list[tuple[Path, str]]:
    """Return addresses of our pages' inline scripts, and those of known services in files.

    Script files of the theme name addresses in licence notes and messages; what they load cannot
    be read off the text, so files are searched for the usual services only.
    """
    inline = [
        (path, url)
        for path, page in site.pages.items()
        for tag in page.find_all("script", src=False)
        for url in SCRIPT_ADDRESS.findall(tag.get_text())
    ]
    files = [
        (path, url)
        for path in sorted(site.root.rglob("*.js"))
        if path.name != "searchindex.js"
        for url in SCRIPT_ADDRESS.findall(path.read_text("utf8", errors="replace"))
        if SERVICES.search(url)
    ]
    return inline + files
