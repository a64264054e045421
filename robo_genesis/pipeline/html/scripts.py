"""The check of scripts: a page runs the scripts of the theme and of the course, and no others.

A page reaches this check as it will be published. An inline script is known by its
digest, a script file by its folder. Whatever else could run script is refused, whoever
wrote it: handlers other than the theme's own, `javascript:` addresses, frames,
plug-ins, refreshes. Two rules keep this parser and a browser's from disagreeing: each
`<script` of the text is an element, and no tag contains `<`.
"""

import hashlib
import io
import json
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from bs4 import BeautifulSoup, Comment, Tag

from robo_genesis.core.files import derived_value

# The inline scripts of the theme and the course by the first 16 digits of their
# SHA-256. After an upgrade of the theme, the check names the new ones: read them, and
# replace the old digests.
KNOWN = {
    "b08c20317fb3eb19": "light or dark before the page shows; the second half is postprocess.py's",
    "d32b2040e449378e": "a word of sphinx-togglebutton",
    "a47df2b7dda58503": "a word of sphinx-togglebutton",
    "16a7e2af3147b51a": "a setting of sphinx-togglebutton",
    "2343be2e4601753a": "what sphinx-togglebutton folds",
    "e39ada5c9c21545b": "a setting of the theme's search",
    "193314e97c9cb956": "math_font's: the font of formulas loads before they show",
    "98dc83e96438bca1": "the page of the search: the cursor goes into its field",
}

# The one inline script that differs by page: the theme's name of the page itself.
PAGE_NAME = "DOCUMENTATION_OPTIONS.pagename = '{}';"

HANDLERS = {("button", "onclick", "window.print()")}  # The theme's own event handlers

# Elements that load another document, a plug-in, or change what addresses mean.
REFUSED = {
    "applet",
    "base",
    "embed",
    "foreignobject",
    "frame",
    "frameset",
    "iframe",
    "object",
}

VIEWER = "model-viewer.js"

# The digest of `replay/model-viewer.js`, which `site/replay/viewer.py` makes of npm's
# file.
VIEWER_SHA256 = "4ba524218533577b1acd9a14afa2a1584ad70290ffd15fe72a65f85aaa72a875"

# The whole of a script that holds the model of a replay.
MODEL = re.compile(
    rb'\(globalThis\.replayModels \?\?= \{\}\)\["[\w-]+"\] = "[A-Za-z0-9+/=]+";\n'
)

# Attributes whose address the script of the replays adds to the page as a script.
LOADED_BY_SCRIPTS = {"data-model", "data-viewer"}

# Suffixes of files that a browser shows or runs, and that no build writes.
OTHER_PAGES = {".htm", ".mjs", ".shtml", ".xht", ".xhtml", ".xml", ".xsl", ".xslt"}

# The same for suffixes that the other checks overlook.
DISGUISED = {".HTML", ".SVG", ".Html", ".Svg"}

SCRIPT_TYPES = (None, "module", "application/json")
RUNNING_ADDRESS = re.compile(
    r"(?:javascript|vbscript):|^blob:|^data:(?!image/(?:png|jpeg);base64,)",
    re.IGNORECASE,
)
UNSEEN = re.compile(
    r"[\x00-\x20\x7f]+"
)  # Characters that browsers leave out of an address
CONTENT = re.compile(r"<(script|style)\b.*?</\1\s*>", re.IGNORECASE | re.DOTALL)
TAG_IN_TAG = re.compile(r"<[a-z/!?][^<>]*<", re.IGNORECASE)
EARLY_END = re.compile(
    r"^-?>|--!>|<!--"
)  # What ends or begins a comment for some parsers only


@dataclass(frozen=True, slots=True)
class Page:
    """A page of a site: the site's folder and path on its server, and the page as file and parsed.

    `base` has a slash at both ends; `text` is the content of the file.
    """

    root: Path
    base: str
    path: Path
    parsed: BeautifulSoup
    text: str


def page_problems(page: Page) -> Iterator[str]:
    """Yield each problem of a page: what it could run besides the known scripts."""
    scripts = 0
    for tag in page.parsed.find_all(True):
        name = _plain(tag.name)
        if name == "script":
            scripts += 1
            yield from _script(page, tag)
        values = {
            name: " ".join(value) if isinstance(value, list) else str(value)
            for name, value in tag.attrs.items()
        }
        yield from _element(name, values)
        for name in LOADED_BY_SCRIPTS & values.keys():
            if not _is_script_of(page, values[name], "replay"):
                yield f"{name}={values[name]!r} is not a script of replay/, as replays load."
    written = page.text.lower().count("<script")
    if written != scripts:
        yield (
            f"the text has {written} times '<script', the parsed page {scripts} scripts. "
            "Escape the others as &lt;script."
        )
    for comment in page.parsed.find_all(string=lambda text: isinstance(text, Comment)):
        if EARLY_END.search(comment):
            yield f"a comment ends early for some browsers: {comment[:80]!r}. Remove it."
    for found in TAG_IN_TAG.findall(CONTENT.sub("", page.text)):
        if not found.startswith("<!--"):
            yield f"a tag contains '<': {found[:80]!r}. Escape it as &lt;."


def file_problems(root: Path) -> Iterator[str]:
    """Yield each file of a site that could run script, and is not a page or a known script file."""
    for path in sorted(path for path in root.rglob("*") if path.is_file()):
        name, suffix = path.relative_to(root).as_posix(), path.suffix.lower()
        if suffix == ".js" and not _known_file(root, path):
            yield f"{name}: the build writes no such script. Valid: scripts in book/_static/."
        elif name != "sitemap.xml" and (
            suffix in OTHER_PAGES or path.suffix in DISGUISED
        ):
            yield f"{name}: a browser may run script in it. Valid: pages .html, drawings .svg."
        elif suffix == ".svg":
            text = path.read_bytes()
            yield from (f"{name}: {found}" for found in _drawing_problems(text))


def _script(page: Page, script: Tag) -> Iterator[str]:
    """Yield why a script element is not a known one."""
    kind, text = script.get("type"), script.string or script.get_text()
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    own_name = PAGE_NAME.format(
        page.path.relative_to(page.root).as_posix().removesuffix(".html")
    )
    if script.parent is not None and script.find_parent(["svg", "math"]):
        yield f"a script is inside a drawing or formula: {text[:80]!r}. Remove it."
    elif kind not in SCRIPT_TYPES or (
        kind == "application/json" and script.has_attr("src")
    ):
        yield f"a script has the type {kind!r}. Valid: none, 'module', or data as application/json."
    elif script.has_attr("src"):
        address = str(script["src"])
        if text.strip() or not _is_script_of(
            page, address, "_static", "searchindex.js"
        ):
            yield f"the script file {address!r} is not known. Valid: files in _static/."
    elif kind == "application/json":
        if "<" in text or not _is_json(text):
            yield f"a script of JSON is not plain JSON without '<': {text[:80]!r}."
    elif digest not in KNOWN and text != own_name:
        yield (
            f"the inline script {digest} is not known: {text.strip()[:120]!r}. If it is new in the "
            "theme, read it and add its digest to KNOWN in html/scripts.py; else remove it."
        )


def _element(tag: str, attributes: Mapping[str, str]) -> Iterator[str]:
    """Yield what an element that is not a script could run; names have no XML prefixes."""
    if tag in REFUSED:
        yield f"the element <{tag}> is not allowed. Remove it."
    if tag == "meta" and attributes.get("http-equiv", "").strip().lower() == "refresh":
        yield f"<meta> leads to another page: {attributes.get('content')!r}. Remove it."
    for name, value in attributes.items():
        what = f"<{tag}> has {name}={value[:80]!r}"
        if name == "srcdoc":
            yield f"{what}, a document of its own. Remove it."
        elif name.startswith("on") and (tag, name, value) not in HANDLERS:
            yield f"{what}, an event handler that is not known. Remove it."
        elif RUNNING_ADDRESS.search(UNSEEN.sub("", value)):
            yield f"{what}, an address that can run script. Remove it."


def _drawing_problems(text: bytes) -> Any:
    return derived_value("drawing", text.hex(), lambda: [*_drawing(text)])


def _drawing(text: bytes) -> Iterator[str]:
    """Yield what a drawing could run if a browser opens it as a page."""
    if re.search(rb"<!ENTITY|<!DOCTYPE[^>]*\[|<\?xml-", text, re.IGNORECASE):
        yield "the drawing declares entities or a style sheet of XML. Remove the declaration."
        return
    try:
        for _, element in ElementTree.iterparse(io.BytesIO(text)):
            tag = _plain(element.tag)
            if tag == "script":
                yield "the drawing contains a script. Remove it."
            yield from _element(tag, {_plain(n): v for n, v in element.attrib.items()})
    except ElementTree.ParseError as error:
        yield f"the drawing is not XML: {error}. Draw it again."


def _known_file(root: Path, path: Path) -> bool:
    """Whether a script file is one that the build writes."""
    parts = path.relative_to(root).parts
    if parts[0] == "replay" and len(parts) == 2:
        if path.name == VIEWER:
            return hashlib.sha256(path.read_bytes()).hexdigest() == VIEWER_SHA256
        return bool(MODEL.fullmatch(path.read_bytes()))
    return parts[0] == "_static" or parts == ("searchindex.js",)


def _is_script_of(page: Page, address: str, *places: str) -> bool:
    """Whether an address of a page is a script file in one of these places of the site."""
    parts = urlsplit(address)
    place = unquote(parts.path)
    if parts.scheme or parts.netloc or not place.endswith(".js"):
        return False
    base = page.root if place.startswith("/") else page.path.parent
    target = (base / place.removeprefix(page.base)).resolve()
    inside = target.is_relative_to(page.root)
    return inside and target.relative_to(page.root).parts[0] in places


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


def _plain(name: str) -> str:
    """Return a name without a prefix or namespace of XML, in small letters."""
    return re.split("[:}]", name)[-1].lower()
