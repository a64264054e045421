"""The check of scripts: a page runs the scripts of the theme and of the course, and no others.

A page reaches this check as it will be published. An inline script is known by its digest, a script
file by its folder; the checks of links and third parties require that it is one of the site.
Whatever else could run script is refused, whoever wrote it: handlers other than the theme's own,
`javascript:` addresses, frames, plug-ins, refreshes. Each `<script` of the text must be an element,
so that this parser and a browser's agree; the last step of a render escapes `<` in tags.
"""

import hashlib
import io
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from bs4 import BeautifulSoup, Comment, Tag

from robo_genesis.core.files import derived_value

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
"""The inline scripts of the theme and the course by the first 16 digits of their SHA-256. After an
upgrade of the theme, the check names the new ones: read them, and replace the old digests."""

PAGE_NAME = "DOCUMENTATION_OPTIONS.pagename = '{}';"
"""The one inline script that differs by page: the theme's name of the page itself."""

HANDLERS = {("button", "onclick", "window.print()")}  # The theme's own event handlers

REFUSED = {"applet", "base", "embed", "foreignobject", "frame", "frameset", "iframe", "object"}
"""Elements that load another document, a plug-in, or change what addresses mean."""

VIEWER = "model-viewer.js"
"""The script in `replay/` that `site/replay/viewer.py` makes of a file with a known digest."""

MODEL = re.compile(rb'\(globalThis\.replayModels \?\?= \{\}\)\["[\w-]+"\] = "[A-Za-z0-9+/=]+";\n')
"""The whole of a script that holds the model of a replay."""

OTHER_PAGES = {".htm", ".mjs", ".shtml", ".xht", ".xhtml", ".xml", ".xsl", ".xslt"}
"""Suffixes of files that a browser shows or runs, and that no build writes."""

DISGUISED = {".HTML", ".SVG", ".Html", ".Svg"}
"""The same for suffixes that the other checks overlook."""

SCRIPT_TYPES = (None, "module", "application/json")
RUNNING_ADDRESS = re.compile(
    r"(?:javascript|vbscript):|^blob:|^data:(?!image/(?:png|jpeg);base64,)", re.IGNORECASE
)
UNSEEN = re.compile(r"[\x00-\x20\x7f]+")  # Characters that browsers leave out of an address
EARLY_END = re.compile(r"^-?>|--!>|<!--")  # What ends or begins a comment for some parsers only


def page_problems(name: str, parsed: BeautifulSoup, text: str) -> Iterator[str]:
    """Yield each problem of a page: what it could run besides the known scripts.

    Args:
        name: the page's address from the home page, without `.html`.
        parsed: the page.
        text: the content of its file.
    """
    scripts = 0
    for tag in parsed.find_all(True):
        element = _plain(tag.name)
        if element == "script":
            scripts += 1
            yield from _script(name, tag)
        values = {
            key: " ".join(value) if isinstance(value, list) else str(value)
            for key, value in tag.attrs.items()
        }
        yield from _element(element, values)
    written = text.lower().count("<script")
    if written != scripts:
        yield (
            f"the text has {written} times '<script', the parsed page {scripts} scripts. "
            "Escape the others as &lt;script."
        )
    for comment in parsed.find_all(string=lambda text: isinstance(text, Comment)):
        if EARLY_END.search(comment):
            yield f"a comment ends early for some browsers: {comment[:80]!r}. Remove it."


def file_problems(root: Path) -> Iterator[str]:
    """Yield each file of a site that could run script, and is not a page or a known script file."""
    for path in sorted(path for path in root.rglob("*") if path.is_file()):
        name, suffix = path.relative_to(root).as_posix(), path.suffix.lower()
        if suffix == ".js" and not _known_file(root, path):
            yield f"{name}: the build writes no such script. Valid: scripts in book/_static/."
        elif name != "sitemap.xml" and (suffix in OTHER_PAGES or path.suffix in DISGUISED):
            yield f"{name}: a browser may run script in it. Valid: pages .html, drawings .svg."
        elif suffix == ".svg":
            text = path.read_bytes()
            yield from (f"{name}: {found}" for found in _drawing_problems(text))


def _script(page: str, script: Tag) -> Iterator[str]:
    """Yield why a script element of a page is not a known one."""
    kind, text = script.get("type"), script.string or script.get_text()
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    if script.parent is not None and script.find_parent(["svg", "math"]):
        yield f"a script is inside a drawing or formula: {text[:80]!r}. Remove it."
    elif kind not in SCRIPT_TYPES or (kind == "application/json" and script.has_attr("src")):
        yield f"a script has the type {kind!r}. Valid: none, 'module', or data as application/json."
    elif script.has_attr("src"):
        address = str(script["src"])
        if text.strip() or not urlsplit(address).path.endswith(".js"):
            yield f"the script file {address!r} is not known. Valid: .js files in _static/."
    elif kind == "application/json":
        if "<" in text:  # no browser runs it, but '<' could end it early
            yield f"a script of JSON has '<': {text[:80]!r}. Escape it as \\u003c."
    elif digest not in KNOWN and text != PAGE_NAME.format(page):
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
        return path.name == VIEWER or bool(MODEL.fullmatch(path.read_bytes()))
    return parts[0] == "_static" or parts == ("searchindex.js",)


def _plain(name: str) -> str:
    """Return a name without a prefix or namespace of XML, in small letters."""
    return re.split("[:}]", name)[-1].lower()
