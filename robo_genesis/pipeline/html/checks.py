"""Checks on the built site that need no browser: links, alt texts, hosts, leftovers, paths."""

import os
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from html.parser import HTMLParser
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

from robo_genesis.core.project import PACKAGES, ROOT

# Each page has this policy: the browser itself then loads nothing from another host.
# `file:` is for a site that is read from disk; the viewer of the replays compiles
# WebAssembly.
POLICY_NAME = "Content-Security-Policy"
POLICY = "default-src 'self' file: data: blob: 'unsafe-inline' 'unsafe-eval'"

CHECKS = ("links", "anchors", "alt texts", "third parties", "leftovers")
ADDRESSES = {"href", "src", "poster", "data", "action"}
FILE_NAME = re.compile(
    r"^\S*\.(?:png|jpe?g|svg|webp|gif)$|^[0-9a-f]{16,}$", re.IGNORECASE
)
# No published file names them. IPython writes a home folder as `~`.
HOME, CHECKOUT = str(Path.home()), str(ROOT)
PRIVATE = (HOME, CHECKOUT, CHECKOUT.replace(HOME, "~"), PACKAGES)
QUOTING = ("pre", "code", "script", "style")
LEFTOVERS = re.compile(
    r"\{[a-z][a-z:_-]*\}(?=`|\()|\\[\[\(]|\$\$|\[\[[^\]]*\]\]|\[\^\S+?\]|<Figure size "
)


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
        self.addresses += [
            url for name in ADDRESSES & given.keys() if (url := given[name].strip())
        ]
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


def run_checks(html: Path, base: str) -> dict[str, list[str]]:
    """Run all checks on a site, and return a line for each problem by the name of the check.

    | check | requirement |
    |---|---|
    | links | each address inside the site leads to a file, each fragment to an element |
    | anchors | no two elements of a page have one id |
    | alt texts | each image has a text that is neither empty nor a file name nor a hash |
    | third parties | the policy of each page forbids other hosts |
    | leftovers | no page shows unprocessed markup, such as a footnote that is not defined |
    | private paths | no published file names the builder's home or checkout |

    Args:
        html: the folder of the site.
        base: the path that it will have on its server, with a slash at both ends.
    """
    root = html.resolve()
    pages = {path: PageReader(path.read_text("utf8")) for path in root.rglob("*.html")}
    found: dict[str, list[str]] = {name: [] for name in CHECKS}
    for path, page in sorted(pages.items()):
        problems = [*page_problems(page)]
        problems += [
            ("links", f"{address!r} {why}")
            for address in page.addresses
            if (why := _broken(address, path, pages, root, base))
        ]
        for name, problem in dict.fromkeys(problems):
            found[name].append(f"{path.relative_to(root)}: {problem}")
    found["private paths"] = [*private_paths(root.parent)]
    return found


def page_problems(page: PageReader) -> Iterator[tuple[str, str]]:
    """Yield (check, problem) of each problem of a page but its links."""
    for anchor, count in Counter(page.anchors).items():
        if count > 1:
            yield "anchors", f"two elements have the id {anchor!r}."
    for text, source in page.alt_texts:
        stem = PurePosixPath(urlsplit(source).path).stem
        if not text.strip() or FILE_NAME.match(text) or text == stem:
            yield "alt texts", f"{source} has the alt text {text!r}."
    if POLICY not in page.policies:
        yield "third parties", f"has no {POLICY_NAME} {POLICY!r}."
    for text in filter(LEFTOVERS.search, page.texts):
        yield "leftovers", repr(text.strip()[:80])


def _broken(
    address: str, page: Path, pages: Mapping[Path, PageReader], root: Path, base: str
) -> str | None:
    """Return why an address inside the site names no file, as a site on disk needs."""
    parts = urlsplit(address)
    if parts.scheme or parts.netloc:
        return None
    place, fragment = unquote(parts.path), unquote(parts.fragment)
    if place.startswith("/") and not place.startswith(base):
        return f"leads out of {base}, the path of the site."
    folder = root if place.startswith("/") else page.parent
    target = page
    if place:
        target = Path(os.path.normpath(folder / place.removeprefix(base)))
    if not (target.is_relative_to(root) and target.is_file()):
        return "leads to no file of the site."
    known = pages.get(target)
    if fragment in ("", "top") or known is None or fragment in known.anchors:
        return None
    return f"names no element of {target.relative_to(root)}."


def private_paths(published: Path) -> Iterator[str]:
    """Yield each published file that names the home folder or the checkout of the builder.

    Args:
        published: the folder of the site and its bundles.
    """
    # A pattern that begins with a constant is found three times as fast.
    roots = b"|".join(re.escape(os.fsencode(path[1:])) for path in PRIVATE)
    private = re.compile(rb"/(?<![\w./-]/)(?:%s)/" % roots)
    for path in published.rglob("*"):
        if path.is_file() and (match := private.search(path.read_bytes())):
            yield f"{path.relative_to(published)}: names {match[0].decode()}"
