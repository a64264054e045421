"""The size of each page in its source, and the limits for its kind; `make lint` compares them."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from docutils.parsers.rst.directives.misc import TestDirective
from myst_parser.parsers.directives import parse_directive_text
from nbformat import NotebookNode
from sphinx.config import Config
from sphinx.directives.code import LiteralIncludeReader

from robo_genesis.pipeline.pages.book import Page
from robo_genesis.site.course.facts import HIDDEN, STUB, WORDS_A_MINUTE, has_sheet, work_minutes
from robo_genesis.site.takeaways.plain_markdown import ADMONITIONS, DIRECTIVE, PARSER
from robo_genesis.site.text.left_out import without_docstrings

COLUMN = 80
"""Most characters in a line of an excerpt that the column shows without scrolling."""

MEASURES = {
    "words": "words of prose", "cells": "visible code cells",
    "longest": "lines in its longest visible cell", "plots": "plots",
    "minutes": "minutes to read and to work", "widest": "characters in its widest line of code",
}  # fmt: skip
"""What is counted, in words."""

LIMITS = {
    "lecture": {"words": 3300, "cells": 12, "longest": 15, "plots": 7, "minutes": 45},
    "lab": {"minutes": 80},
    "mistakes": {"words": 2000},
    "deeper": {"words": 2000},
}
"""The largest numbers by kind of page: the first word of its name."""

SHOWN_AS_PROSE = {*ADMONITIONS, "admonition", "seealso"}
INCLUDE = re.compile(r"^ *```\{literalinclude\} *(\S+)\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
PLOT = re.compile(r"\bplots?\.\w+|_plots\.\w+|\bsubplots\(")
QUESTION = re.compile(r"^ *[`:]{3,}\{(?:choice|number)\}", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Size:
    """The size of one page; the fields are those of `MEASURES`."""

    words: int
    cells: int
    longest: int
    plots: int
    minutes: int
    widest: int


def size(notebook: NotebookNode, file: Path) -> Size:
    """Return the size of a page.

    Args:
        notebook: the page's source.
        file: of the page; its excerpts are relative to its folder.
    """
    texts = [cell.source for cell in notebook.cells if cell.cell_type == "markdown"]
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    visible = [c for c in code if not HIDDEN.intersection(c.metadata.get("tags", ()))]
    lines = [sum(bool(line.strip()) for line in cell.source.splitlines()) for cell in visible]
    widths = (0, *(len(line) for cell in visible for line in cell.source.splitlines()))
    words = sum(map(count_words, texts))
    questions = sum(len(QUESTION.findall(text)) for text in texts)
    functions = sum(STUB in cell.source for cell in visible)
    work = work_minutes(sum(lines), questions, functions, has_sheet(file))
    return Size(
        words=words,
        cells=len(visible),
        longest=max(lines, default=0),
        plots=sum(bool(PLOT.search(cell.source)) for cell in code),
        minutes=round(words / WORDS_A_MINUTE + work),
        widest=max((*widths, *(width for t in texts for width in excerpt_widths(t, file.parent)))),
    )


def count_words(text: str) -> int:
    """Return the number of words of running text: no folds, tables, captions, code or formulas."""
    words, in_table = 0, False
    for token in PARSER.parse(text):
        directive = DIRECTIVE.match(token.info.strip())
        if token.type in ("table_open", "table_close"):
            in_table = token.type == "table_open"
        elif token.type == "inline" and not in_table:
            words += len(token.content.split())
        elif directive and directive[1] in SHOWN_AS_PROSE:
            inside = parse_directive_text(TestDirective, directive[2], token.content)
            if "dropdown" not in inside.options.get("class", ""):
                words += count_words("\n".join(inside.body))
    return words


def excerpt_widths(text: str, folder: Path) -> Iterator[int]:
    """Yield the widest line of each excerpt of the package, as the page shows it."""
    for path, body in INCLUDE.findall(text):
        options = parse_directive_text(TestDirective, path, body).options
        if "dedent" in options:
            options["dedent"] = int(options["dedent"])
        code, _ = LiteralIncludeReader(str((folder / path).resolve()), options, Config()).read()
        yield max(map(len, without_docstrings(code).splitlines()), default=0)


def excess(found: Size, kind: str) -> list[str]:
    """Return a phrase for each number of a page that is over the limit for its kind."""
    limits = {**LIMITS.get(kind, {}), "widest": COLUMN}
    return [
        f"{number:,} {MEASURES[name]} (at most {limit:,})"
        for name, limit in limits.items()
        if (number := getattr(found, name)) > limit
    ]


def report(pages: Iterable[Page]) -> tuple[list[str], list[str]]:
    """Return a line for each page, and what to do about each page that is too large.

    Args:
        pages: the executed pages of the book.
    """
    lines, problems = [], []
    for page in pages:
        found = size(page.notebook, page.path)
        numbers = ", ".join(f"{getattr(found, name):,} {what}" for name, what in MEASURES.items())
        lines.append(f"{page.docname}: {numbers}")
        if over := excess(found, page.path.stem.partition("-")[0]):
            problems.append(
                f"{page.docname} is over its size: {'; '.join(over)}. Shorten it, or move a part "
                "to a deeper page."
            )
    return lines, problems
