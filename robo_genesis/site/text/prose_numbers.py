"""Decimal numbers typed in prose: inputs that a lesson lists; measured ones are inserted."""

import re
import runpy
from pathlib import Path

from robo_genesis.sim.bodies.free_fall import GRAVITY

LISTS = "tests/lessons/*/prose_numbers.py"
"""Each lesson's module has `CONFIGURED`: the chosen inputs that its prose may type, by meaning."""
PAGES = ("*.md", "[el]*/**/*.md")

DECIMAL = re.compile(r"(?<![\w.])(?:\d*\.\d+(?:e[-+]?\d+)?|\d+e[-+]?\d+)(?!\.\d)", re.IGNORECASE)
NO_PROSE = {
    r"\A---\n.*?\n---\n": "",
    r"^```\{code-cell\}[^\n]*\n((?:---\n.*?^---\n)?).*?^```": r"\1",
    r"^```\{literalinclude\}.*?^```": "",
    r"\]\([^)\s]*\)": "]",
    r"\bPython 3\.\d+(?: to 3\.\d+)?": "Python",
    r"\{[\w-]+\}`[^`\n]+`": "",
}
"""Front matter, code, addresses and roles, and what is kept of them: the options of cells."""


def typed_numbers(book: Path, root: Path) -> list[str]:
    """Return a line for each page whose text, tables, formulas or captions type another number.

    Args:
        book: the folder of the pages.
        root: the checkout, for the lists.
    """
    chosen = [GRAVITY]
    for path in root.glob(LISTS):
        chosen += runpy.run_path(str(path))["CONFIGURED"].values()
    allowed, lines = {f"{value:g}" for value in chosen}, []
    for page in sorted(path for pattern in PAGES for path in book.glob(pattern)):
        source = page.read_text("utf8")
        for pattern, kept in NO_PROSE.items():
            source = re.sub(pattern, kept, source, flags=re.DOTALL | re.MULTILINE)
        if found := sorted(set(DECIMAL.findall(source)) - allowed):
            lines.append(
                f"{page.relative_to(book)} types {', '.join(found)}. Insert what was measured with "
                f"{{measured}}; list what was chosen in {LISTS}."
            )
    return lines
