"""A report as a Markdown page.

Text of a bundle is escaped: it cannot control a terminal, begin a line or become
    markup.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment

from .files import write_whole
from .text import printable

Cells = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Part:
    """A heading with remarks and a table, whose first row is its head.

    `state` is that of the worst row, empty for a table without states. `empty` is the
    text in the place of a table that has only a head.
    """

    heading: str
    rows: Sequence[Cells]
    empty: str = "There are none."
    remarks: Sequence[str] = ()
    state: str = ""


@dataclass(frozen=True, slots=True)
class Document:
    """A report: its title, its verdict in one sentence, remarks and parts."""

    title: str
    verdict: str
    parts: Sequence[Part]
    remarks: Sequence[str] = ()

    def markdown(self) -> str:
        """Return the report as a Markdown page."""
        environment = Environment(trim_blocks=True, lstrip_blocks=True)
        environment.filters["plain"] = _plain
        template = Path(__file__).with_suffix(".md").read_text("utf8")
        text = environment.from_string(template).render(document=self)
        return re.sub(r"\n{3,}", "\n\n", text).strip() + "\n"

    def write(self, folder: Path) -> Path:
        """Write the page and return its path."""
        path = folder / "report.md"
        write_whole(path, self.markdown().encode())
        return path


def _plain(text: str) -> str:
    """Return text as one line, with the characters escaped that have a meaning in Markdown."""
    line = printable(" ".join(text.split()))
    return "".join(f"\\{c}" if c in "\\`*_|[]<>#" else c for c in line)
