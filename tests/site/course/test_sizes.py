"""What counts as prose, code and plots of a page, and which sizes are refused."""

import re

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from robo_genesis.core.project import BOOK
from robo_genesis.site.course import sizes


@pytest.mark.parametrize(
    ("text", "words", "beside"),
    [
        ("# Title\n\nTwo words.", 3, 0),
        ("A.\n\n| a | b |\n| - | - |\n| c | d |\n\n(old-name)=\nB.", 2, 4),
        ("A.\n```{figure} a.svg\n:alt: x\n\nA caption.\n```\nB.", 2, 2),
        (":::{admonition} Title\n:class: tip\nIn it.\n:::", 2, 0),
        (":::{admonition} Title\n:class: tip dropdown\nIn it.\n:::\nB.", 1, 0),
        ("::::{dropdown} Fold\n:::{note}\nIn it.\n:::\nIn it.\n::::\nB.", 1, 0),
        ("```python\ncode\n```\nB.", 1, 0),
        ("{term}`DOFs<degree of freedom>`", 1, 0),
        ("```{math}\nx + 1\n```\nB.", 1, 0),
    ],
)
def test_tables_and_captions_are_read_but_are_not_prose(text, words, beside):
    assert sizes.count_words(text) == words
    assert sizes.count_words(text, beside=True) == words + beside


WORDS = "word " * 150
TABLE = "| a | b |\n| - | - |\n" + "| c | d |\n" * 149  # 300 words
ASKED = "```{choice} l04/lab a b c\nWhen?\n```\n\n:::{dropdown} Answer\nSo.\n:::"
STUB = "def fall():\n    raise NotImplementedError"


def ran(code, *tags, text="", **data):
    """A code cell with what it printed and displayed, below a figure's caption of 150 words."""
    figure = {"mystnb": {"figure": {"caption": WORDS}}} if "figure" in tags else {}
    cell = new_code_cell(code, metadata={"tags": [*tags], **figure})
    cell.outputs = [new_output("stream", text=text), new_output("display_data", data)]
    return cell


@pytest.mark.parametrize(
    ("name", "cells", "read", "work", "size"),
    [
        # 300 words of text and 300 in a table; nothing to do
        ("deeper", [WORDS + WORDS + f"\n\n{TABLE}"], 4, 0, (300, 0, 0)),
        # 150 words, 150 printed, 300 displayed, 150 in a caption, and a log in a fold;
        # 20 lines, a question and a checkpoint
        (
            "lecture",
            [
                f"{WORDS}\n\n{ASKED}",
                ran("a = 1\n\n" * 20, text="1.5 " * 150),
                ran("show()", "hide-input", **{"text/markdown": TABLE}),
                ran("show()", "hide-input", "figure"),
                ran("log()", "hide-cell", text=WORDS),
            ],
            5,
            2 + 2 + 1,
            (150, 1, 20),
        ),
        # 150 words; 20 lines, two functions, a run and a work sheet
        (
            "lab",
            [WORDS, ran(STUB), ran(STUB), ran("a = 1\n" * 16)],
            1,
            2 + 20 + 5 + 10,
            (150, 3, 16),
        ),
    ],
)
def test_three_pages_have_the_size_that_was_counted_by_hand(
    tmp_path, name, cells, read, work, size
):
    (tmp_path / "worksheet.md").touch()
    cells = [new_markdown_cell(c) if isinstance(c, str) else c for c in cells]
    minutes, found = sizes.size(new_notebook(cells=cells), tmp_path / f"{name}.md")
    assert (minutes.read, minutes.work, minutes.sheet) == (read, work, name == "lab")
    assert tuple(found.values()) == (*size, read + work)


def test_readers_find_the_numbers_of_the_computation():
    section = (BOOK / "index.md").read_text().split("(minutes)=")[1].split("\n\n")[1]
    values = [value for name, value in vars(sizes).items() if "MINUTE" in name]
    counted = {value for value in values if isinstance(value, int)}
    assert {*map(int, re.findall(r"\d+", section))} == counted


def test_a_large_page_is_named(tmp_path):
    """A page without code too; a lab has no limit for its words."""
    pages = {name: tmp_path / f"{name}.md" for name in ("lecture", "practice", "lab")}
    for file in pages.values():
        file.write_text("word " * 3400 + f"\n\n{ASKED}" * 3)
    lecture, practice = sizes.report(pages)
    assert lecture.startswith(
        "lecture is over its size: 3,400 words of prose (at most 3,300)"
    )
    assert practice.startswith(
        "practice is over its size: 32 minutes to read and to work (at most 30)"
    )
    assert practice.endswith("Shorten it, or move a part to a deeper page.")
