"""Checks of executed cells; whole pages are executed in test_execute."""

import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output

from robo_genesis.build.page_results import last_lines, unexpected_outcome

RAISES = {"tags": ["raises-exception"], "expects": "ValueError: no"}


def picture(kind):
    return new_output("display_data", data={kind: "<svg/>"})


def raised(name, message):
    return new_output("error", ename=name, evalue=message, traceback=[])


@pytest.mark.parametrize(
    ("metadata", "outputs", "said"),
    [
        ({"tags": ["figure"]}, [picture("text/plain")], "FigureMissing tagged figure, but shows"),
        ({"tags": ["figure"]}, [picture("image/svg+xml")], None),
        ({"tags": ["figure"]}, [picture("image/png")], None),
        ({}, [], None),
        ({}, [raised("KeyError", "kp")], "raised KeyError: kp, but is not tagged raises-exception"),
        (RAISES, [raised("ValueError", "no way")], None),
        (RAISES, [], "expected was 'ValueError: no', but the cell raised no exception."),
        (RAISES, [raised("ValueError", "maybe")], "but the cell raised ValueError: maybe."),
        (RAISES, [raised("KeyError", "no")], "but the cell raised KeyError: no."),
        (
            {"tags": ["raises-exception"]},
            [raised("ValueError", "no")],
            "it raised ValueError: no. Add the option `expects:",
        ),
        ({"expects": "ValueError: no"}, [], "without the tag raises-exception"),
        ({"tags": ["skip-execution"]}, [], "skip-execution is not allowed"),
    ],
)
def test_a_cell_has_its_figure_and_its_expected_exception_or_fails_its_page(
    metadata, outputs, said
):
    book = new_notebook(cells=[new_code_cell("draw()", metadata=metadata, outputs=outputs)])
    failure = unexpected_outcome(book, book)
    if said is None:
        assert failure is None
    else:
        assert failure.cell == 1
        assert said.removeprefix("FigureMissing ") in failure.message
        figure = said.startswith("FigureMissing")
        assert failure.error == ("FigureMissing" if figure else "ExpectedException")


def test_last_lines_are_few_and_without_colours():
    text = "".join(f"\x1b[31mline {n}\x1b[0m\n" for n in range(40))
    assert last_lines(text) == tuple(f"line {n}" for n in range(25, 40))
