"""Judging executed cells; whole pages are executed in test_execute."""

import nbformat
import pytest

from robo_genesis.build.page_results import last_lines, unexpected_outcome


def notebook(tags, outputs):
    cell = nbformat.v4.new_code_cell("draw()", metadata={"tags": tags}, outputs=outputs)
    return nbformat.v4.new_notebook(cells=[cell])


def picture(kind):
    return nbformat.v4.new_output("display_data", data={kind: "<svg/>"})


def test_a_figure_cell_without_a_figure_fails_its_page():
    text = nbformat.v4.new_output("display_data", data={"text/plain": "<Figure>"})
    book = notebook(["figure"], [text])
    failure = unexpected_outcome(book, book)
    assert (failure.error, failure.cell) == ("FigureMissing", 1)
    assert "tagged figure, but shows none" in failure.message


@pytest.mark.parametrize("kind", ["image/svg+xml", "image/png"])
def test_a_figure_cell_with_its_figure_passes(kind):
    book = notebook(["figure"], [picture(kind)])
    assert unexpected_outcome(book, book) is None


def test_a_cell_without_the_tag_may_show_nothing():
    book = notebook([], [])
    assert unexpected_outcome(book, book) is None


def test_last_lines_are_few_and_without_colours():
    text = "".join(f"\x1b[31mline {n}\x1b[0m\n" for n in range(40))
    assert last_lines(text) == tuple(f"line {n}" for n in range(25, 40))
