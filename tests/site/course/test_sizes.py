"""What counts as prose, code and plots of a page, and which sizes are refused."""

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from robo_genesis.pipeline.pages.book import Page
from robo_genesis.site.course import sizes


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("# Title\n\nTwo words.", 3),
        ("A.\n\n| a | b |\n| - | - |\n| c | d |\n\n(old-name)=\nB.", 2),
        ("A.\n```{figure} a.svg\n:alt: x\n\nA caption.\n```\nB.", 2),
        (":::{admonition} Title\n:class: tip\nIn it.\n:::", 2),
        (":::{admonition} Title\n:class: tip dropdown\nIn it.\n:::\nB.", 1),
        ("::::{dropdown} Fold\n:::{note}\nIn it.\n:::\nIn it.\n::::\nB.", 1),
        ("```python\ncode\n```\nB.", 1),
        ("{term}`DOFs<degree of freedom>`", 1),
        ("```{math}\nx + 1\n```\nB.", 1),
    ],
)
def test_folds_tables_captions_and_code_are_not_prose(text, words):
    assert sizes.count_words(text) == words


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
