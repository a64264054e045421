"""Checks of executed cells; whole pages are executed in test_execute."""

import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output
from small_book import executed
from tiny_book import cell, make_book, notebook, raising

from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.page_folder import executed_cells
from robo_genesis.pipeline.pages.results import at_cell, unexpected_outcome

RAISES = {"tags": ["raises-exception"], "expects": "ValueError: no"}


def picture(kind, content="<svg/>"):
    return new_output("display_data", data={kind: content})


def raised(name, message):
    return new_output("error", ename=name, evalue=message, traceback=[])


def prints(text):
    return new_output("stream", text=text)


FIGURE, SVG = {"tags": ["figure"]}, "image/svg+xml"
WRONG = (
    (FIGURE, [picture("text/plain")], "FigureMissing", "tagged figure, but shows none"),
    (
        {},
        [picture(SVG)],
        "FigureUntagged",
        "shows a picture. Tag it figure, and describe",
    ),
    (
        FIGURE,
        [picture(SVG, '<p fill="#1f77b4"/>')],
        "Colour",
        "draws in #1f77b4. A page draws in",
    ),
    (
        FIGURE,
        [picture("image/png", "A" * 2_000_001)],
        "OutputSize",
        "draw fewer points",
    ),
    (
        {},
        [picture("text/markdown", "x" * 100_001)],
        "OutputSize",
        "puts out 100,001 characters",
    ),
    (
        {},
        [picture("text/html")],
        "OutputKind",
        "puts out text/html. Show a table as `Markdown(",
    ),
    ({}, [picture("video/mp4")], "OutputKind", "a motion by the directive {replay}"),
    (
        {},
        [picture("text/plain", "<Line2D at 0x7f5a>")],
        "OutputChanges",
        "'at 0x7f5a'. It differs",
    ),
    ({}, [prints("a /tmp/tmp8ykmu1dh/b")], "OutputChanges", "'/tmp8ykmu1dh'"),
    ({}, [prints("3\x08 4")], "OutputChanges", r"'\x08'"),
    (
        {},
        [raised("KeyError", "kp")],
        "ExpectedException",
        "raised KeyError: kp, but is not tagged",
    ),
    (
        RAISES,
        [],
        "ExpectedException",
        "was 'ValueError: no', but the cell raised no exception.",
    ),
    (
        RAISES,
        [raised("ValueError", "hm")],
        "ExpectedException",
        "the cell raised ValueError: hm.",
    ),
)


def outcome(metadata, outputs, folder):
    book = new_notebook(
        cells=[new_code_cell("draw()", metadata=metadata, outputs=outputs)]
    )
    book.metadata.source_map = [3]
    path = folder / "page.md"
    path.write_text("---\n---\n```\ndraw()\n")
    return unexpected_outcome(Page("page", path, book), book)


@pytest.mark.parametrize(("metadata", "outputs", "error", "said"), WRONG)
def test_what_a_page_cannot_show_fails_it_in_its_cell(
    tmp_path, metadata, outputs, error, said
):
    failure = outcome(metadata, outputs, tmp_path)
    assert (failure.cell, failure.line, failure.source) == (1, 4, "draw()")
    assert failure.error == error
    assert said in failure.message


@pytest.mark.parametrize(
    ("metadata", "outputs"),
    [
        (FIGURE, [picture(SVG)]),
        (FIGURE, [picture(SVG, '<image/><p fill="#1f77b4"/>')]),
        ({}, [prints("0x1f of /tmp/demo, at once\n" * 99)]),
        (RAISES, [raised("ValueError", "no way")]),
    ],
)
def test_what_a_page_can_show_passes(tmp_path, metadata, outputs):
    assert outcome(metadata, outputs, tmp_path) is None


HELPER = "def helper():\n    raise ValueError('in another cell')"
FAILING = [  # the code of a cell, its error, and how its failing line begins
    ("two = 2\n# 1 / 0 in a comment\n1 / 0\nthree = 3", "ZeroDivisionError", "1 / 0"),
    ("print(\n    1,\n    1 / 0,\n)", "ZeroDivisionError", "1 / 0,"),
    ("def own():\n    raise ValueError\n\nown()", "ValueError", "raise ValueError"),
    ("one = 1\n\nhelper()", "ValueError", "helper()"),
    ("import json\njson.loads('{')\none = 1", "JSONDecodeError", "json.loads"),
    (
        "try:\n    1 / 0\nexcept ArithmeticError as e:\n    raise KeyError from e",
        "KeyError",
        "raise KeyError",
    ),
    ("one = 1\ntwo = = 2", "SyntaxError", "two = = 2"),
    ("if True:\n    one = 1\n  two = 2", "IndentationError", "two = 2"),
    ("one = 1\n%run no_such_file.py", "Exception", "%run no"),
    ("one = 1\nraise SystemExit(3)", "SystemExit", "one = 1"),  # without a traceback
]


@pytest.fixture(scope="module")
def failing(tmp_path_factory):
    """The page whose cells fail, and the same as it was executed."""
    folder = tmp_path_factory.mktemp("failing")
    cells = [raising(code, error) for code, error, _ in FAILING]
    [page] = find_pages(make_book(folder, page=notebook(cell(HELPER), *cells)))
    [result] = executed([page], folder)
    return page, executed_cells(result.folder)


@pytest.mark.parametrize("number", range(len(FAILING)))
def test_a_failure_names_the_line_of_the_cell_that_failed(failing, number):
    page, executed = failing
    code = [n for n, part in enumerate(page.notebook.cells) if part.cell_type == "code"]
    failure = at_cell(
        page, code[number + 1], "E", "message", executed.cells[number + 1]
    )
    assert failure.cell == number + 2
    assert failure.source.startswith(FAILING[number][2])
    assert (
        page.path.read_text().splitlines()[failure.line - 1].strip() == failure.source
    )
