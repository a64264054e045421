"""The size of each page in its source and its minutes, and the limits of `make lint`."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from docutils.parsers.rst.directives.misc import TestDirective
from myst_parser.parsers.directives import parse_directive_text
from nbformat import NotebookNode
from nbformat.v4 import new_markdown_cell, new_notebook

from robo_genesis.pipeline.pages.book import (
    LAB,
    WORK_SHEET,
    code_cells,
    read_notebook,
)
from robo_genesis.pipeline.pages.page_index import executed_notebook
from robo_genesis.site.takeaways.plain_markdown import ADMONITIONS, DIRECTIVE, PARSER

# These numbers are on the home page, below "How the minutes are counted".

# A slow pace, for technical prose, tables, captions and outputs
WORDS_A_MINUTE = 150
LINES_A_MINUTE = 10  # The pace of somebody who runs and changes visible code
MINUTES_A_QUESTION = 2
MINUTES_A_CHECKPOINT = 1  # To think of an answer before a fold shows it
# An estimate of the time to write a function until its test passes
MINUTES_A_FUNCTION = 10

# An estimate of the time of one run of a lab, in which the engine compiles its kernels.
MINUTES_A_RUN = 5
MINUTES_A_SHEET = 10  # An estimate of the time to fill in a work sheet
# An estimate of the time for choices and writing in the capstone
MINUTES_A_PROJECT = 75
PROJECTS = {LAB: 0, "capstone": MINUTES_A_PROJECT}  # The pages with a work sheet
# Occurs in a cell with a function that the reader writes
STUB = "raise NotImplementedError"

# Tags of cells whose code is not visible, and of those whose outputs are not.
HIDDEN = {"hide-cell", "hide-input", "remove-cell"}
NO_OUTPUT = {"hide-cell", "hide-output", "remove-cell"}

# What is counted on a page, in words.
MEASURES = {
    "words": "words of prose",
    "cells": "visible code cells",
    "longest": "lines in its longest visible cell",
    "minutes": "minutes to read and to work",
}

# The largest numbers by kind of page: the first word of its name. `make lint` knows no outputs.
LECTURE = {"words": 3300, "cells": 12, "longest": 15, "minutes": 65}
LIMITS = {
    "lecture": LECTURE,
    "motion": LECTURE,  # the second part of L04's lecture
    "practice": {"minutes": 30},
    "lab": {"minutes": 90},
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


def count_minutes(docname: str, page: Path) -> Minutes:
    """Return the time that a page takes, with its outputs if it was executed.

    Args:
        docname: the name of the page.
        page: its file.
    """
    notebook = notebook_of(page)
    if cells := code_cells(notebook):
        executed = executed_notebook(docname, notebook)
        for cell, ran in zip(cells, executed.cells, strict=True):
            cell.outputs = ran.outputs
    return size(notebook, page)[0]


def notebook_of(page: Path) -> NotebookNode:
    """Return the notebook of a page; one without code is a cell of text."""
    text = new_notebook(cells=[new_markdown_cell(page.read_text("utf8"))])
    return read_notebook(page) or text


def size(notebook: NotebookNode, file: Path) -> tuple[Minutes, dict[str, int]]:
    """Return the time that a page takes, and its size by the names of `MEASURES`.

    A page with functions to write is also run.

    Args:
        notebook: the page, whose outputs count if it has them.
        file: of the page.
    """
    texts = [cell.source for cell in notebook.cells if cell.cell_type == "markdown"]
    visible = [
        cell.source
        for cell in code_cells(notebook)
        if not HIDDEN.intersection(cell.metadata.get("tags", ()))
    ]
    lines = [sum(map(bool, map(str.strip, code.splitlines()))) for code in visible]
    functions = sum(STUB in code for code in visible)
    work = sum(lines) / LINES_A_MINUTE
    work += functions * MINUTES_A_FUNCTION + bool(functions) * MINUTES_A_RUN
    for text in texts:
        work += len(QUESTION.findall(text)) * MINUTES_A_QUESTION
        work += len(THOUGHT.findall(text)) * MINUTES_A_CHECKPOINT
    sheet = file.stem in PROJECTS and file.with_name(WORK_SHEET).is_file()
    work += PROJECTS.get(file.stem, 0)
    words = sum(map(count_words, texts))
    read_words = sum(count_words(text, beside=True) for text in texts)
    read_words += sum(map(count_shown, notebook.cells))
    read = max(1, round(read_words / WORDS_A_MINUTE))
    minutes = Minutes(read, round(work + sheet * MINUTES_A_SHEET), sheet)
    longest = max(lines, default=0)
    sizes = {"words": words, "cells": len(visible), "longest": longest}
    return minutes, sizes | {"minutes": minutes.total}


def count_words(text: str, beside: bool = False) -> int:
    """Return the number of words of running text: no folds, code or formulas.

    Args:
        text: MyST Markdown.
        beside: whether also tables and captions count.
    """
    words, skipped = 0, False
    for token in PARSER.parse(text):
        directive = DIRECTIVE.match(token.info.strip())
        if token.type in ("table_open", "table_close"):
            skipped = token.type == "table_open" and not beside
        elif token.type == "inline" and not skipped:
            words += len(ENTRY.sub("", token.content).split())
        elif directive and directive[1] in SHOWN_AS_PROSE | (
            {"figure"} if beside else set()
        ):
            inside = parse_directive_text(TestDirective, directive[2], token.content)
            if "dropdown" not in inside.options.get("class", ""):
                words += count_words("\n".join(inside.body), beside)
    return words


def count_shown(cell: NotebookNode) -> int:
    """Return the number of words that a code cell prints or displays, and of its caption."""
    if NO_OUTPUT.intersection(cell.metadata.get("tags", ())):
        return 0
    figure = cell.metadata.get("mystnb", {}).get("figure", {})
    words = count_words(figure.get("caption", ""))
    for output in cell.get("outputs", ()):
        words += len(output.get("text", "").split())
        words += count_words(output.get("data", {}).get("text/markdown", ""), True)
    return words


def report(pages: Mapping[str, Path]) -> list[str]:
    """Return what to do about each page that is too large.

    Args:
        pages: the file of each page of the book by its name.
    """
    problems = []
    for name, file in pages.items():
        kind = file.stem.partition("-")[0]
        _, found = size(notebook_of(file), file)
        over = [
            f"{found[of]:,} {MEASURES[of]} (at most {limit:,})"
            for of, limit in LIMITS.get(kind, {}).items()
            if found[of] > limit
        ]
        if over:
            problems.append(
                f"{name} is over its size: {'; '.join(over)}. Shorten it, or move a part "
                "to a deeper page."
            )
    return problems
