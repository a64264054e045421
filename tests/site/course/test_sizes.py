"""What counts as prose, code and plots of a page, and which sizes are refused."""

import re

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.pages.book import Page
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


TABLE = "| a | b |\n| - | - |\n" + "| c | d |\n" * 149  # 300 words
ASKED = "```{choice} l04/lab a b c\nWhen?\n```\n\n:::{dropdown} Answer\nSo.\n:::"
STUB = "def fall():\n    raise NotImplementedError"


def ran(code, *tags, text="", caption="", **data):
    """A code cell, what it printed and displayed, and the caption of its figure."""
    figure = {"mystnb": {"figure": {"caption": caption}}} if caption else {}
    cell = new_code_cell(code, metadata={"tags": [*tags], **figure})
    cell.outputs = [new_output("stream", name="stdout", text=text)]
    cell.outputs += [new_output("display_data", data=data)]
    return cell


@pytest.mark.parametrize(
    ("name", "cells", "read", "work"),
    [
        # 300 words of text and 300 in a table; nothing to do
        ("deeper", [new_markdown_cell("word " * 300 + f"\n\n{TABLE}")], 4, 0),
        # 150 words, 150 printed, 300 displayed, 150 in a caption; 150 are in a fold.
        # 20 lines, a question and a checkpoint
        (
            "lecture",
            [
                new_markdown_cell("word " * 150 + f"\n\n{ASKED}"),
                ran("a = 1\n" * 20, text="1.5 " * 150),
                ran("show()", "hide-input", **{"text/markdown": TABLE}),
                ran("show()", "hide-input", caption="word " * 150),
                ran("log()", "hide-cell", text="word " * 150),
            ],
            5,
            2 + 2 + 1,
        ),
        # 150 words; 20 lines, two functions, a run and a work sheet
        (
            "lab",
            [
                new_markdown_cell("word " * 150),
                ran(STUB),
                ran(STUB),
                ran("a = 1\n" * 16),
            ],
            1,
            2 + 20 + 5 + 10,
        ),
    ],
)
def test_three_pages_take_the_minutes_that_were_counted_by_hand(
    tmp_path, name, cells, read, work
):
    (tmp_path / "worksheet.md").touch()
    minutes, _ = sizes.size(new_notebook(cells=cells), tmp_path / f"{name}.md")
    assert (minutes.read, minutes.work, minutes.sheet) == (read, work, name == "lab")


def test_readers_find_the_numbers_of_the_computation():
    section = (BOOK / "index.md").read_text().split("(minutes)=")[1].split("\n\n")[1]
    values = [value for name, value in vars(sizes).items() if "MINUTE" in name]
    counted = {value for value in values if isinstance(value, int)}
    assert {*map(int, re.findall(r"\d+", section))} == counted


def test_a_page_s_size(tmp_path):
    asked = "```{choice} l04/lab a b c\nWhen?\n```\n\n:::{dropdown} Answer\nSo.\n:::"
    asked += "\n\n:::{dropdown} Details\nMore.\n:::"
    cells = [
        new_markdown_cell(f"{'word ' * 400}\n\n{asked}"),
        new_code_cell("a = 1\n\nb = 2\npage.show(l04.plots.baseline)"),
        new_code_cell(
            "page.show(l04.plots.step_size)", metadata={"tags": ["hide-input"]}
        ),
        new_code_cell("c = 3"),
    ]
    _, found = sizes.size(new_notebook(cells=cells), tmp_path / "lecture.md")
    assert found == {
        "words": 400,
        "cells": 2,
        "longest": 3,
        "minutes": 6,
    }


def test_a_large_page_is_named(tmp_path):
    large = new_notebook(cells=[new_markdown_cell("word " * 3400)])
    pages = [
        Page(name, tmp_path / f"{name}.md", large, None, None)
        for name in ("lecture", "lab")
    ]
    (problem,) = sizes.report(pages)
    assert problem.startswith(
        "lecture is over its size: 3,400 words of prose (at most 3,300)"
    )
    assert problem.endswith("Shorten it, or move a part to a deeper page.")
