"""Checks on the built site that need no browser: links, alt texts, scripts, leftovers."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urldefrag, urlsplit

from bs4 import BeautifulSoup, Tag

from robo_genesis.build.site import scripts

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
    """One check: how many things it examined, and a line for each problem."""

    name: str
    count: int
    problems: tuple[str, ...]


class Site:
    """The files of a built site, each page parsed and walked once."""

    def __init__(self, html: Path, base: str = "/"):
        self.root, self.base = html.resolve(), base
        self.texts = {p: p.read_text("utf8") for p in sorted(self.root.rglob("*.html"))}
        self.pages = {p: BeautifulSoup(text, "html.parser") for p, text in self.texts.items()}
        self.anchors: dict[Path, set[str]] = {}
        self.addresses: list[tuple[Path, Tag, str]] = []
        self.styles = [(path, path.read_text("utf8")) for path in sorted(self.root.rglob("*.css"))]
        for path, page in self.pages.items():
            tags = page.find_all(True)
            names = (tag.get(name) for tag in tags for name in ("id", "name"))
            self.anchors[path] = {str(name) for name in names if name}
            self.addresses += [(path, tag, url) for tag in tags for url in _addresses(tag)]
            self.styles += [(path, tag.get_text()) for tag in tags if tag.name == "style"]
            self.styles += [(path, str(tag["style"])) for tag in tags if tag.has_attr("style")]

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
    checks = (check_links, check_alt_texts, check_third_parties, check_scripts, check_leftovers)
    return [check(site) for check in checks]


def check_links(site: Site) -> SiteCheck:
    """Every address inside the site leads to a file, and every fragment to an element."""
    found = [(path, url) for path, _, url in site.addresses] + _style_addresses(site)
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
        return f"leads out of {site.base}, the path of the site."
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
    """Every image has an alternative text that is neither empty nor a file name nor a hash."""
    images = [
        (path, image)
        for path, page in site.pages.items()
        for image in page.select("img, svg.drawing")
    ]
    problems = []
    for path, image in images:
        names = ("alt", "src") if image.name == "img" else ("aria-label", "data-file")
        text, source = (str(image.get(name) or "").strip() for name in names)
        if not text or FILE_NAME.match(text) or text == PurePosixPath(urlsplit(source).path).stem:
            problems.append(f"{site.name(path)}: {source} has the alt text {text!r}.")
    return SiteCheck("alt texts", len(images), tuple(problems))


def check_third_parties(site: Site) -> SiteCheck:
    """Nothing is loaded from another address; links that a reader may follow are allowed."""
    found = [(path, url) for path, tag, url in site.addresses if _is_loaded(tag)]
    found += _style_addresses(site) + _script_addresses(site)
    problems = sorted({f"{site.name(path)}: {url}" for path, url in found if ELSEWHERE.match(url)})
    return SiteCheck("third parties", len(found), tuple(problems))


def check_scripts(site: Site) -> SiteCheck:
    """The site runs the scripts of the theme and of the course only; see `scripts`."""
    pages = [
        scripts.Page(site.root, site.base, path, page, site.texts[path])
        for path, page in site.pages.items()
    ]
    problems = {
        f"{site.name(page.path)}: {line}" for page in pages for line in scripts.page_problems(page)
    }
    number = sum(len(page.parsed.find_all("script")) for page in pages)
    found = (*sorted(problems), *scripts.file_problems(site.root))
    return SiteCheck("scripts", number, found)


def check_leftovers(site: Site) -> SiteCheck:
    """No page shows unprocessed markup, or an error of the page generator."""
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


def _addresses(tag: Tag) -> Iterator[str]:
    """Yield every address that an element carries."""
    for name in tag.attrs.keys() & ADDRESSES:
        value = str(tag.get(name) or "").strip()
        listed = [part.split()[:1] for part in value.split(",")] if name == "srcset" else [[value]]
        yield from (url for urls in listed for url in urls if url)


def _is_loaded(tag: Tag) -> bool:
    """Whether the browser itself asks for the element's address."""
    kinds = {str(kind).lower() for kind in tag.get("rel") or []}
    return tag.name not in ("a", "area") and not (tag.name == "link" and kinds & NOT_LOADED)


def _style_addresses(site: Site) -> list[tuple[Path, str]]:
    """Return the addresses in style sheets, style elements and style attributes."""
    return [
        (path, url)
        for path, text in site.styles
        for url in CSS_ADDRESS.findall(CSS_COMMENT.sub("", text))
        if url[:1] != "#"
    ]


def _script_addresses(site: Site) -> list[tuple[Path, str]]:
    """Return addresses of our pages' inline scripts, and those of known services in files.

    Script files of the theme contain addresses in licence notes and messages, and their text does
    not show which ones they load; so files are searched for the usual services only.
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
