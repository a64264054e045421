"""A lecture's visible code is one script: plain Genesis and NumPy, in the order of the page."""

import ast
import json
import subprocess
import sys
from itertools import zip_longest

import nbformat
import pytest
from built_site import OUTSIDE, executed_pages
from lessons.exercise_cells import page_of

from robo_genesis.core import project
from robo_genesis.lessons import LESSONS
from robo_genesis.pipeline.command import ANSI
from robo_genesis.pipeline.pages.page_folder import NOTEBOOK
from robo_genesis.pipeline.pages.values import LOG
from robo_genesis.site.course.sizes import HIDDEN

MODULES = {"genesis", "mujoco", "numpy", "robo_genesis", "torch"}
OF_COURSE = {"rg.model_file"}  # Where the model of a lesson lies
FAILS = "raises-exception"  # A cell that shows an error; a script would end there
NEXT = "next cell"  # What the script prints between two cells


def shown(cell, *others: str) -> bool:
    """Whether a cell with code is visible, and has none of further tags."""
    tags = {*cell.metadata.get("tags", ())}
    return cell.cell_type == "code" and not tags & {*HIDDEN, *others}


def script(lesson: str, name: str, *left_out: str) -> list[str]:
    cells = page_of(lesson, name).notebook.cells
    return [cell.source for cell in cells if shown(cell, *left_out)]


PARTS = [*((lesson, "lecture") for lesson in LESSONS), ("l04", "motion")]


@pytest.mark.parametrize(("lesson", "name"), PARTS)
def test_it_needs_nothing_of_the_course(lesson, name):
    code = ast.parse("\n".join(script(lesson, name)))
    nodes = [*ast.walk(code)]
    imported = {
        name.name for n in nodes if isinstance(n, ast.Import) for name in n.names
    }
    assert imported <= MODULES
    assert not any(isinstance(node, ast.ImportFrom) for node in nodes)
    found = {
        ast.unparse(node)
        for node in nodes
        if isinstance(node, ast.Name | ast.Attribute)
    }
    assert not found & {"page", *LESSONS}
    assert {name for name in found if name.startswith("rg.")} <= OF_COURSE


# All lectures; each takes a quarter of a minute, so those of one lesson run by default.
RUN = [
    pytest.param(*part, marks=[pytest.mark.slow] * (part[0] != "l04")) for part in PARTS
]


@pytest.mark.engine
@pytest.mark.parametrize(("lesson", "name"), RUN)
def test_pasted_into_an_empty_file_it_prints_what_the_page_shows(
    lesson, name, tmp_path
):
    between = f"\nprint({json.dumps(NEXT)}, flush=True)\n"
    (tmp_path / "script.py").write_text(between.join(script(lesson, name, FAILS)))
    done = subprocess.run(
        [sys.executable, "script.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env=OUTSIDE
        | project.engine_cache_environment()
        | {"PYTHONPATH": str(project.ROOT)},
    )
    assert done.returncode == 0, done.stderr[-3000:]
    page = page_of(lesson, name)
    executed = nbformat.read(
        executed_pages().folders[page.docname] / NOTEBOOK, as_version=4
    )
    cells = [cell for cell in page.notebook.cells if cell.cell_type == "code"]
    printed = [
        "".join(out.text for out in ran.outputs if out.get("name") == "stdout")
        for cell, ran in zip(cells, executed.cells, strict=True)
        if shown(cell, FAILS)
    ]
    for said, expected in zip_longest(done.stdout.split(f"{NEXT}\n"), printed):
        assert LOG.sub("", ANSI.sub("", said)).strip() == LOG.sub("", expected).strip()
