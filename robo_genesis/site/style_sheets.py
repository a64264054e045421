"""Removes the rules of the theme's style sheets that no page of the site can match."""

import json
import re
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from robo_genesis.build import npm
from robo_genesis.build.command import end_with_parent
from robo_genesis.core.files import derived
from robo_genesis.core.project import ProjectError

SHEETS = (
    "_static/styles/pydata-sphinx-theme.css",
    "_static/styles/sphinx-book-theme.css",
    "_static/sphinx-design.min.css",
    "_static/mystnb.*.css",
)
"""Sheets of the theme and its extensions, relative to the site. The course's own stay."""

NAMES = (re.compile(rb' class="([^"]*)"'), re.compile(rb' id="([^"]*)"'))
"""Classes and identifiers of a page, which its tags name."""
WORD = re.compile(rb"[\w-]+")
OTHER_WORD = re.compile(rb"(?<![.#\w-])[\w-]+")
"""A word of a sheet that is neither a class nor an identifier: elements, attributes, states."""
PURGE = "purgecss/bin/purgecss.js"


def trim_sheets(html: Path) -> None:
    """Remove from each sheet the rules with classes or identifiers that the site does not have.

    A name counts as present if a tag of any page has it or if it is a word of any script, which
    may add it later. Rules that name elements and attributes alone stay.

    Args:
        html: folder of the site, whose sheets are changed in place.

    Raises:
        ProjectError: PurgeCSS failed; the message holds its output.
    """
    sheets = {path.name: path for name in SHEETS for path in html.glob(name)}
    content = {name: path.read_bytes() for name, path in sheets.items()}
    present = used_names(html) | words(content.values(), OTHER_WORD)
    names = b"\n".join(sorted(present & words(content.values(), WORD)))
    inputs = [names, *content.values(), Path(__file__).read_bytes()]
    found = derived("sheets", inputs, lambda: json.dumps(_purged(content, names)).encode())
    for name, text in json.loads(found).items():
        sheets[name].write_text(text, "utf8")


def used_names(html: Path) -> set[bytes]:
    """Return the classes and identifiers of all pages, and all words of their common scripts."""
    pages = [path.read_bytes() for path in html.rglob("*.html")]
    attributes = (set(pattern.findall(page)) for page in pages for pattern in NAMES)
    names = {name for values in attributes for value in values for name in value.split()}
    return names | words((path.read_bytes() for path in html.glob("_static/**/*.js")), WORD)


def words(texts: Iterable[bytes], pattern: re.Pattern[bytes]) -> set[bytes]:
    """Return all matches of a pattern in texts."""
    return {word for text in texts for word in pattern.findall(text)}


def _purged(content: Mapping[str, bytes], names: bytes) -> dict[str, str]:
    """Return the sheets without the rules that name none of some words."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "names.txt").write_bytes(names)
        for sheet, text in content.items():
            (folder / sheet).write_bytes(text)
        (folder / "out").mkdir()
        command = [str(npm.node()), str(npm.packages() / PURGE), "--keyframes"]
        done = subprocess.run(
            [*command, "--content", "names.txt", "--output", "out", "--css", *content],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
            preexec_fn=end_with_parent(),
        )
        made = {sheet: folder / "out" / sheet for sheet in content}
        if done.returncode or not all(path.is_file() for path in made.values()):
            raise ProjectError(f"PurgeCSS failed:\n{done.stdout}{done.stderr}")
        return {sheet: path.read_text("utf8") for sheet, path in made.items()}
