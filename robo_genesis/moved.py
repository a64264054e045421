"""Sentences of a built site that read differently in another build of the same pages.

The pages are the same, so a sentence that changed was measured or computed: an inserted number, a
sentence or table row of a cell's output, a caption, a status.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path

from bs4 import BeautifulSoup, NavigableString, Tag
from bs4.element import PreformattedString

BLOCKS = ("p", "li", "tr", "figcaption", "caption", "dt", "dd", "pre", "h1", "h2", "h3", "h4")
INSERTED, COMPUTED, STATUS = "inserted number", "cell output", "status or caption"
LEFT_OUT = ("genindex.html", "search.html", "evidence/ledger.html")
"""Pages without sentences of their own. The ledger lists digests, which differ in any two runs;
the tables and states behind them are compared on the pages that show them."""

RUN = re.compile(
    r"(?:(?<=\brun )|(?<=\brun \| ))[0-9a-f]{8}(?:[0-9a-f]{24})?\b(?!\.\d)"
    r"|\b\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d[\d:.]*Z?)?\b"
)
"""What differs between any two runs of one version: run ids after the word `run`, and dates."""

LOG = re.compile(r"\[(Genesis\b|[TDIWEC] \d\d/\d\d/)")
"""How a line of the engine's or its compiler's log begins; warnings are compared from bundles."""

END = re.compile(r"(?<=[.!?])\s+(?=[^\s\d])")


@dataclass(frozen=True, slots=True)
class Sentence:
    """One sentence of a page, its white space made even, and what wrote it."""

    text: str
    kind: str

    @property
    def content(self) -> str:
        """The text without what differs between any two runs."""
        return RUN.sub("…", self.text)


@dataclass(frozen=True, slots=True)
class Moved:
    """A sentence that changed; one of the two texts is empty where it came or went."""

    page: str
    kind: str
    old: str
    new: str


def moved_sentences(old: Path, new: Path) -> list[Moved]:
    """Return the sentences that differ between two builds, in the order of pages.

    Args:
        old: folder of the one build's HTML.
        new: folder of the other's.
    """
    names = {p.relative_to(site).as_posix() for site in (old, new) for p in site.rglob("*.html")}
    found: list[Moved] = []
    for name in sorted(name for name in names if name not in LEFT_OUT):
        texts = [(site / name).read_text("utf8") if (site / name).is_file() else ""
                 for site in (old, new)]  # fmt: skip
        found += _changes(name.removesuffix(".html"), *(list(sentences(t)) for t in texts))
    return found


def _changes(page: str, old: list[Sentence], new: list[Sentence]) -> Iterator[Moved]:
    """Pair the sentences that take each other's place, in order."""
    matcher = SequenceMatcher(None, [s.content for s in old], [s.content for s in new], False)
    for tag, a, b, c, d in matcher.get_opcodes():
        if tag == "equal":
            continue
        for k in range(max(b - a, d - c)):
            was = old[a + k] if a + k < b else None
            now = new[c + k] if c + k < d else None
            kind = (now or was).kind  # type: ignore[union-attr]
            yield Moved(page, kind, was.text if was else "", now.text if now else "")


def sentences(html: str) -> Iterator[Sentence]:
    """Yield the sentences of a page's article; the source of cells and the formulas are left out.

    A table row is one sentence, a line of printed output as well; the engine's log is none.
    """
    soup = BeautifulSoup(html, "html.parser")
    article = soup.select_one("article") or soup
    for block, strings in _by_block(article):
        kind = _kind(block)
        if block.name == "pre":
            lines = "".join(strings).splitlines()
            pieces = [line for line in lines if not LOG.match(line)]
        elif block.name == "tr":
            pieces = [" | ".join(cell.get_text() for cell in block.find_all(["th", "td"]))]
        else:
            pieces = END.split("".join(strings).strip())
        for piece in pieces:
            if text := " ".join(piece.split()):
                yield Sentence(text, kind)


def _by_block(article: Tag) -> list[tuple[Tag, list[str]]]:
    """Return the blocks in order, each with the strings that belong to no block within it."""
    blocks: dict[int, tuple[Tag, list[str]]] = {}
    for string in article.find_all(string=True):
        assert isinstance(string, NavigableString)
        above = list(string.parents)
        hidden = any(p.name in ("script", "style", "math") for p in above)
        if isinstance(string, PreformattedString) or hidden or _is_source(above):
            continue
        block = next((p for p in above if p.name == "tr"), None) or next(
            (p for p in above if p.name in BLOCKS), None
        )
        if block is not None:
            blocks.setdefault(id(block), (block, []))[1].append(str(string))
    return list(blocks.values())


def _is_source(above: list[Tag]) -> bool:
    return any("cell_input" in p.get("class", []) for p in above)


def _kind(block: Tag) -> str:
    """Say what wrote a block: the role for measured values, a cell, or a directive."""
    if block.select_one(".measured"):
        return INSERTED
    if any("cell_output" in parent.get("class", []) for parent in (block, *block.parents)):
        return COMPUTED
    return STATUS
