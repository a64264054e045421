"""Each function that a page leaves to the student has a stub, a short solution, and a test."""

import re

import pytest
from lessons.exercise_cells import page_of

from robo_genesis.core.exercises import FUNCTIONS
from robo_genesis.core.project import BOOK
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.pages.book import find_pages

STUBS = [
    (page.lesson, stub[1], page.page)
    for page in find_pages(BOOK)
    for cell in page.notebook.cells
    if "raise NotImplementedError" in cell.source
    and (stub := re.search(r"^def (\w+)\(", cell.source, re.M))
]


@pytest.mark.parametrize("stub", STUBS, ids=lambda stub: " ".join(stub))
def test_the_student_writes_at_most_fifteen_lines_below_a_docstring(stub):
    """Only the site shows two hints, with a link, and the solution; a cell tests the function."""
    lesson, name, page = stub
    all_cells = page_of(lesson, page).notebook.cells
    empty, solution = [c for c in all_cells if f"def {name}(" in c.source]
    assert '"""' in empty.source
    assert "solution" not in empty.metadata.get("tags", [])
    assert "solution" in solution.metadata["tags"]
    assert len(solution.source.splitlines()) - 1 <= 15
    if page == "lab":
        hints = all_cells[all_cells.index(solution) - 1]
        assert hints.metadata.get("tags") == ["site-only"]
        assert hints.source.count("{dropdown} Hint") == 2
        assert re.search(r"\{(ref|eq|numref)\}", hints.source)
    assert re.search(
        rf"page\.test\([\w.]+, {name}[,)]", "\n".join(c.source for c in all_cells)
    )
    declared = find_page(lesson, page).readings[FUNCTIONS].units
    assert [*declared] == [
        stub[1] for stub in STUBS if (stub[0], stub[2]) == (lesson, page)
    ]


def test_each_lab_leaves_functions_to_write():
    labs = {page.lesson for page in find_pages(BOOK) if page.page == "lab"}
    assert labs == {lesson for lesson, _, page in STUBS if page == "lab"}
