"""A report as a Markdown page.

Text of a bundle is escaped: it cannot control a terminal, begin a line or become
    markup.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core import tables
from robo_genesis.core.files import write_whole
from robo_genesis.core.text import bullets, printable

Cells = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Part:
    """A heading with remarks and a table, whose first row is its head.

    `state` is that of the worst row, empty for a table without states. `empty` is the
    text in the place of a table that has only a head.
    """

    heading: str
    rows: Sequence[Cells]
    empty: str = ""
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
        remarks = bullets(map(_plain, self.remarks))
        blocks = [f"# {_plain(self.title)}", f"**{self.verdict}**", remarks]
        for part in self.parts:
            state = f": {part.state}" if part.state else ""
            blocks += [
                f"## {_plain(part.heading)}{state}",
                bullets(map(_plain, part.remarks)),
            ]
            blocks.append(
                _markdown_table(part.rows) if len(part.rows) > 1 else part.empty
            )
        return "\n\n".join(block for block in blocks if block) + "\n"

    def write(self, folder: Path) -> Path:
        """Write the page and return its path."""
        path = folder / "report.md"
        write_whole(path, self.markdown().encode())
        return path


def _markdown_table(rows: Sequence[Cells]) -> str:
    head, *body = ([_plain(cell) for cell in row] for row in rows)
    return tables.markdown([dict(zip(head, row, strict=True)) for row in body]).strip()


def _plain(text: str) -> str:
    """Return text as one line, with the characters escaped that have a meaning in Markdown."""
    line = printable(" ".join(text.split()))
    return "".join(f"\\{c}" if c in "\\`*_|[]<>#" else c for c in line)
