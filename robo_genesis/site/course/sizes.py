"""The size of each page in its source, and the limits for its kind; `make lint` compares them."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from docutils.parsers.rst.directives.misc import TestDirective
from myst_parser.parsers.directives import parse_directive_text
from nbformat import NotebookNode

from robo_genesis.pipeline.pages.book import Page
from robo_genesis.site.course.facts import HIDDEN, STUB, WORDS_A_MINUTE, has_sheet, work_minutes
from robo_genesis.site.takeaways.plain_markdown import ADMONITIONS, DIRECTIVE, PARSER, excerpt
from robo_genesis.site.text.left_out import without_docstrings

COLUMN = 80  # Most characters in a line of an excerpt that the column shows without scrolling

MEASURES = {
    "words": "words of prose", "cells": "visible code cells",
    "longest": "lines in its longest visible cell", "plots": "plots",
    "minutes": "minutes to read and to work", "widest": "characters in its widest line of code",
}  # fmt: skip
"""What is counted on a page, in words."""

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


def size(notebook: NotebookNode, file: Path) -> dict[str, int]:
    """Return the size of a page by the names of `MEASURES`.

    Args:
        notebook: the page's source.
        file: of the page; its excerpts are relative to its folder.
    """
    texts = [cell.source for cell in notebook.cells if cell.cell_type == "markdown"]
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    visible = [c for c in code if not HIDDEN.intersection(c.metadata.get("tags", ()))]
    lines = [sum(bool(line.strip()) for line in cell.source.splitlines()) for cell in visible]
    widths = [0, *(len(line) for cell in visible for line in cell.source.splitlines())]
    words = sum(map(count_words, texts))
    questions = sum(len(QUESTION.findall(text)) for text in texts)
    functions = sum(STUB in cell.source for cell in visible)
    work = work_minutes(sum(lines), questions, functions, has_sheet(file))
    return {
        "words": words,
        "cells": len(visible),
        "longest": max(lines, default=0),
        "plots": sum(bool(PLOT.search(cell.source)) for cell in code),
        "minutes": round(words / WORDS_A_MINUTE + work),
        "widest": max(sum((excerpt_widths(t, file.parent) for t in texts), widths)),
    }


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


def excerpt_widths(text: str, folder: Path) -> list[int]:
    """Return the widths of all lines of the excerpts of the package, as the page shows them."""
    shown = (without_docstrings(excerpt(folder, *include)) for include in INCLUDE.findall(text))
    return [len(line) for code in shown for line in code.splitlines()]


def excess(found: Mapping[str, int], kind: str) -> list[str]:
    """Return a phrase for each number of a page that is over the limit for its kind."""
    limits = {**LIMITS.get(kind, {}), "widest": COLUMN}
    return [
        f"{number:,} {MEASURES[name]} (at most {limit:,})"
        for name, limit in limits.items()
        if (number := found[name]) > limit
    ]


def report(pages: Iterable[Page]) -> tuple[list[str], list[str]]:
    """Return a line for each page, and what to do about each page that is too large.

    Args:
        pages: the executed pages of the book.
    """
    lines, problems = [], []
    for page in pages:
        found = size(page.notebook, page.path)
        numbers = ", ".join(f"{found[name]:,} {what}" for name, what in MEASURES.items())
        lines.append(f"{page.docname}: {numbers}")
        if over := excess(found, page.path.stem.partition("-")[0]):
            problems.append(
                f"{page.docname} is over its size: {'; '.join(over)}. Shorten it, or move a part "
                "to a deeper page."
            )
    return lines, problems
