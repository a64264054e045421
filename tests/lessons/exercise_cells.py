"""The functions that a lab leaves to the student: their cells, and our solutions."""

import ast
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from robo_genesis.core.checks import Check
from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.pages.book import Page, find_pages


@cache
def page_of(lesson: str, name: str) -> Page:
    """Return an executed page of a lesson."""
    (found,) = (
        page for page in find_pages(BOOK) if (page.lesson, page.page) == (lesson, name)
    )
    return found


def solutions(lesson: str, page: str = "lab") -> dict[str, Any]:
    """Return our solutions on a page by the name of the function."""
    given = page_of(lesson, page)
    statements = [line for code in given.code.sources for line in ast.parse(code).body]
    imports = [
        line
        for line in statements
        if isinstance(line, ast.ImportFrom)
        and str(line.module).startswith(("robo_", "scipy."))
    ]
    solved: dict[str, Any] = {"np": np}
    exec(compile(ast.Module(imports, []), given.docname, "exec"), solved)
    for cell in given.notebook.cells:
        if "solution" in cell.metadata.get("tags", []):
            exec(cell.source, solved)
    return solved


def with_mistake(lesson: str, name: str, old: str, new: str, page: str = "lab") -> Any:
    """Return our solution on a page of a lesson with a replacement in its code."""
    (source,) = (
        cell.source
        for cell in page_of(lesson, page).notebook.cells
        if "solution" in cell.metadata.get("tags", []) and f"def {name}(" in cell.source
    )
    assert old in source
    solved = solutions(lesson, page)
    exec(source.replace(old, new), solved)
    return solved[name]


def undetected(
    test: Callable[..., Check],
    mistakes: dict[str, list[str]],
    lesson: str,
    name: str,
    *given: Any,
    page: str = "lab",
) -> list[tuple[str, str]]:
    """Return the mistakes in our solution that a test lets pass. It has to pass ours.

    Args:
        test: of a student's function.
        mistakes: what is replaced in the code of our solution, and what replaces it.
        lesson: of the page.
        name: of the function.
        given: to the test beside the function.
        page: that has the function.
    """
    ours = test(with_mistake(lesson, name, "", "", page), *given)
    assert ours.passed, ours.detail
    return [
        (old, new)
        for old, changes in mistakes.items()
        for new in changes
        if test(with_mistake(lesson, name, old, new, page), *given).passed
    ]
