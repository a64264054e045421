"""The size of each page in its source and its minutes, and the limits of `make lint`."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from docutils.parsers.rst.directives.misc import TestDirective
from myst_parser.parsers.directives import parse_directive_text
from nbformat import NotebookNode
from nbformat.v4 import new_markdown_cell, new_notebook

from robo_genesis.pipeline.pages.book import LAB, WORK_SHEET, Page, read_notebook
from robo_genesis.site.takeaways.plain_markdown import ADMONITIONS, DIRECTIVE, PARSER

# A slow pace, for technical prose; code, tables and formulas are not counted
WORDS_A_MINUTE = 150
LINES_A_MINUTE = 10  # The pace of somebody who runs and changes visible code
MINUTES_A_QUESTION = 2
MINUTES_A_CHECKPOINT = 1  # To think of an answer before a fold shows it
# An estimate of the time to write a function until its test passes
MINUTES_A_FUNCTION = 10

# An estimate of the time of one run of a lab, in which the engine compiles its kernels.
MINUTES_A_RUN = 5
MINUTES_A_SHEET = 10  # An estimate of the time to fill in a work sheet
# Occurs in a cell with a function that the reader writes
STUB = "raise NotImplementedError"

# Tags of cells whose code is not visible.
HIDDEN = {"hide-cell", "hide-input", "remove-cell"}

# What is counted on a page, in words.
MEASURES = {
    "words": "words of prose",
    "cells": "visible code cells",
    "longest": "lines in its longest visible cell",
    "minutes": "minutes to read and to work",
}

# The largest numbers by kind of page: the first word of its name.
LECTURE = {"words": 3300, "cells": 12, "longest": 15, "minutes": 50}
LIMITS = {
    "lecture": LECTURE,
    "motion": LECTURE,  # the second part of L04's lecture
    "lab": {"minutes": 80},
    "mistakes": {"words": 2000},
    "deeper": {"words": 2000},
}

SHOWN_AS_PROSE = {*ADMONITIONS, "admonition", "seealso"}
# The entry of a term, in a role whose text differs: not visible.
ENTRY = re.compile(r"(?<=\w)<[^<>]+>(?=`)")
QUESTION = re.compile(r"^ *[`:]{3,}\{(?:choice|number)\}", re.MULTILINE)

# The beginning of a fold that a reader opens after an own answer.
THOUGHT = re.compile(
    r"^ *[`:]{3,}\{dropdown\} *(?:answer|diagnosis)", re.MULTILINE | re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class Minutes:
    """The time that a page takes, in whole minutes: to read it, and for its code and questions.

    `sheet` is true if the work includes a work sheet.
    """

    read: int
    work: int
    sheet: bool = False

    @property
    def total(self) -> int:
        """The minutes together."""
        return self.read + self.work

    def __str__(self) -> str:
        if self.sheet:
            return f"{5 * round(self.total / 5)} min with the work sheet"
        if self.work:
            return f"{self.total} min ({self.read} reading, {self.work} code and questions)"
        return f"{self.total} min to read"


def count_minutes(page: Path) -> Minutes:
    """Return the time that a page takes."""
    text = new_notebook(cells=[new_markdown_cell(page.read_text("utf8"))])
    return size(read_notebook(page) or text, page)[0]


def size(notebook: NotebookNode, file: Path) -> tuple[Minutes, dict[str, int]]:
    """Return the time that a page takes, and its size by the names of `MEASURES`.

    A page with functions to write is also run.

    Args:
        notebook: the page's source.
        file: of the page.
    """
    texts = [cell.source for cell in notebook.cells if cell.cell_type == "markdown"]
    visible = [
        cell.source
        for cell in notebook.cells
        if cell.cell_type == "code"
        and not HIDDEN.intersection(cell.metadata.get("tags", ()))
    ]
    lines = [sum(map(bool, map(str.strip, code.splitlines()))) for code in visible]
    functions = sum(STUB in code for code in visible)
    work = sum(lines) / LINES_A_MINUTE
    work += functions * MINUTES_A_FUNCTION + bool(functions) * MINUTES_A_RUN
    for text in texts:
        work += len(QUESTION.findall(text)) * MINUTES_A_QUESTION
        work += len(THOUGHT.findall(text)) * MINUTES_A_CHECKPOINT
    sheet = file.stem == LAB and file.with_name(WORK_SHEET).is_file()
    words = sum(map(count_words, texts))
    read = max(1, round(words / WORDS_A_MINUTE))
    minutes = Minutes(read, round(work + sheet * MINUTES_A_SHEET), sheet)
    longest = max(lines, default=0)
    sizes = {"words": words, "cells": len(visible), "longest": longest}
    return minutes, sizes | {"minutes": minutes.total}


def count_words(text: str) -> int:
    """Return the number of words of running text: no folds, tables, captions, code or formulas."""
    words, in_table = 0, False
    for token in PARSER.parse(text):
        directive = DIRECTIVE.match(token.info.strip())
        if token.type in ("table_open", "table_close"):
            in_table = token.type == "table_open"
        elif token.type == "inline" and not in_table:
            words += len(ENTRY.sub("", token.content).split())
        elif directive and directive[1] in SHOWN_AS_PROSE:
            inside = parse_directive_text(TestDirective, directive[2], token.content)
            if "dropdown" not in inside.options.get("class", ""):
                words += count_words("\n".join(inside.body))
    return words


def report(pages: Iterable[Page]) -> list[str]:
    """Return what to do about each page that is too large.

    Args:
        pages: the executed pages of the book.
    """
    problems = []
    for page in pages:
        kind = page.path.stem.partition("-")[0]
        _, found = size(page.notebook, page.path)
        over = [
            f"{found[name]:,} {MEASURES[name]} (at most {limit:,})"
            for name, limit in LIMITS.get(kind, {}).items()
            if found[name] > limit
        ]
        if over:
            problems.append(
                f"{page.docname} is over its size: {'; '.join(over)}. Shorten it, or move a part "
                "to a deeper page."
            )
    return problems
