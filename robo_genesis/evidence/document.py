"""A report as a Markdown page and as an HTML page that fetches nothing.

Text of a bundle is escaped: it cannot control a terminal, begin a line or become markup.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core import tables
from robo_genesis.core.files import write_whole
from robo_genesis.core.markup import filled
from robo_genesis.core.text import bullets, printable
from robo_genesis.evidence.rows import SEVERITY

Cells = tuple[str, ...]

PAGE = Path(__file__).with_suffix(".html")  # Its template


@dataclass(frozen=True, slots=True)
class Part:
    """A heading with remarks and a table, whose first row is its head.

    `state` is that of the worst row, empty for a table without states. `empty` is the text in the
    place of a table that has only a head.
    """

    heading: str
    rows: Sequence[Cells]
    empty: str = ""
    remarks: Sequence[str] = ()
    state: str = ""


@dataclass(frozen=True, slots=True)
class Document:
    """A report: its title, its verdict in one sentence with the state, remarks and parts."""

    title: str
    verdict: str
    state: str
    parts: Sequence[Part]
    remarks: Sequence[str] = ()

    def markdown(self) -> str:
        """Return the report as a Markdown page."""
        remarks = bullets(map(_plain, self.remarks))
        blocks = [f"# {_plain(self.title)}", f"**{self.verdict}**", remarks]
        for part in self.parts:
            state = f": {part.state}" if part.state else ""
            blocks += [f"## {_plain(part.heading)}{state}", bullets(map(_plain, part.remarks))]
            blocks.append(_markdown_table(part.rows) if len(part.rows) > 1 else part.empty)
        return "\n\n".join(block for block in blocks if block) + "\n"

    def html(self) -> str:
        """Return the report as one HTML page without scripts, fonts or pictures from elsewhere."""
        return filled(PAGE, report=self, states=SEVERITY, line=_one_line)

    def write(self, folder: Path) -> list[Path]:
        """Write both pages and return their paths."""
        pages = {folder / "report.md": self.markdown(), folder / "report.html": self.html()}
        for path, text in pages.items():
            write_whole(path, text.encode())
        return list(pages)


def _markdown_table(rows: Sequence[Cells]) -> str:
    head, *body = ([_plain(cell) for cell in row] for row in rows)
    return tables.markdown([dict(zip(head, row, strict=True)) for row in body]).strip()


def _one_line(text: str) -> str:
    """Return text as one line, without characters that change how others are shown."""
    return printable(" ".join(text.split()))


def _plain(text: str) -> str:
    """Return text with the characters escaped that have a meaning in Markdown."""
    return "".join(f"\\{c}" if c in "\\`*_|[]<>#" else c for c in _one_line(text))
