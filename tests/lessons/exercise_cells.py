"""The functions that a lab leaves to the student: their cells, our solutions, what both must be."""

import re
from importlib import import_module
from typing import Any

import numpy as np

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.pages.book import Page, find_pages

LONGEST = 15
"""Most lines of a solution below its first one."""


def page_of(lesson: str, name: str) -> Page:
    """Return an executed page of a lesson."""
    (found,) = (page for page in find_pages(BOOK) if (page.lesson, page.page) == (lesson, name))
    return found


def solutions(lesson: str, page: str = "lab") -> dict[str, Any]:
    """Return our solutions on a page by the name of the function."""
    names = {"np": np, lesson: import_module(f"robo_genesis.lessons.{lesson}")}
    solved: dict[str, Any] = names  # as the set-up cell of the notebook imports them
    for cell in page_of(lesson, page).notebook.cells:
        if "solution" in cell.metadata.get("tags", []):
            exec(cell.source, solved)
    return solved


def require_exercise(lesson: str, name: str, page: str = "lab") -> None:
    """Require a stub with a docstring, a short solution that only the site shows, and a test."""
    all_cells = page_of(lesson, page).notebook.cells
    stub, solution = [c for c in all_cells if c.source.startswith(f"def {name}(")]
    assert '"""' in stub.source
    assert "NotImplementedError" in stub.source
    assert "solution" not in stub.metadata.get("tags", [])
    assert "solution" in solution.metadata["tags"]
    assert len(solution.source.splitlines()) - 1 <= LONGEST
    assert re.search(rf"exercises\.\w+\({name}[,)]", "\n".join(c.source for c in all_cells))
