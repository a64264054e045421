"""The functions that a lab leaves to the student: their cells, and our solutions."""

import ast
from functools import cache
from typing import Any

import numpy as np

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
        if isinstance(line, ast.ImportFrom) and str(line.module).startswith("robo_")
    ]
    solved: dict[str, Any] = {"np": np}
    exec(compile(ast.Module(imports, []), given.docname, "exec"), solved)
    for cell in given.notebook.cells:
        if "solution" in cell.metadata.get("tags", []):
            exec(cell.source, solved)
    return solved


def with_mistake(lesson: str, name: str, old: str, new: str) -> Any:
    """Return our solution in the lab of a lesson with a replacement in its code."""
    (source,) = (
        cell.source
        for cell in page_of(lesson, "lab").notebook.cells
        if "solution" in cell.metadata.get("tags", []) and f"def {name}(" in cell.source
    )
    assert old in source
    solved = solutions(lesson)
    exec(source.replace(old, new), solved)
    return solved[name]
