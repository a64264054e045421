"""Each measured figure on a page is what its cell draws from the arrays of the page's bundle.

The build itself compares the outputs of a page that calls `page.show`; these are the other pages.
The cells see the page's imports and its `traces`. `redraw.py` beside a lesson's tests gives the
further names that they use.
"""

import ast
import runpy
from pathlib import Path

import nbformat
import pytest
from built_site import MEASURING_PAGES, executed_pages
from nbclient import NotebookClient

from robo_genesis.build.page_folder import NOTEBOOK
from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.lessons.book_pages import Page, cell_sources, find_pages

pytestmark = pytest.mark.engine

LESSONS = Path(__file__).parents[1] / "lessons"
NAMES = """
import runpy
from pathlib import Path
import numpy as np
from PIL import Image
from robo_genesis.evidence.bundle import read_arrays
from robo_genesis.evidence.trace_files import read_any_trace

plotting.use_course_style()
folder, camera = Path({folder!r}), True
frames = {{n: np.array(Image.open(folder / "frames" / f"{{n}}.png")) for n in ("initial", "final")}}
arrays = read_arrays(folder)
traces = {{case: read_any_trace(folder, arrays, case) for case in arrays.cases}}
"""
FURTHER = "globals().update(runpy.run_path({script!r})['names'](folder))"


def imports(page: Page) -> str:
    """Return the imports of a page's cells, except those of the engine and of other libraries."""
    found = [node for source in cell_sources(page) for node in ast.walk(ast.parse(source))]
    kept = ("robo_genesis", "matplotlib", "numpy", "IPython", "dataclasses")
    return "\n".join(
        ast.unparse(node)
        for node in found
        if isinstance(node, ast.Import | ast.ImportFrom)
        and (getattr(node, "module", None) or node.names[0].name).split(".")[0] in kept
    )


def name_of(cell) -> str:
    return cell.metadata["mystnb"]["figure"]["name"]


def svgs(cells) -> list[str]:
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    return [o["data"]["image/svg+xml"] for o in outputs if "image/svg+xml" in o.get("data", {})]


def opens_a_page(lesson: str, name: str) -> bool:
    (page,) = (p for p in find_pages(BOOK) if (p.lesson, p.page) == (lesson, name))
    return any("rg.open_page" in source for source in cell_sources(page))


OTHERS = [names for names in MEASURING_PAGES if not opens_a_page(*names)]


@pytest.mark.parametrize(("lesson", "name"), OTHERS)
def test_figures_are_drawn_from_the_bundle_s_arrays(build_output, monkeypatch, lesson, name):
    for variable, value in (("ROBO_GENESIS_RENDER", "1"), ("ROBO_GENESIS_BACKEND", "cpu")):
        monkeypatch.setenv(variable, value)
    (page,) = (p for p in find_pages(BOOK) if (p.lesson, p.page) == (lesson, name))
    built = executed_pages()
    executed = nbformat.read(built.folders[page.docname] / NOTEBOOK, as_version=4)
    script = LESSONS / lesson / "redraw.py"
    redraw = runpy.run_path(str(script)) if script.is_file() else {}
    before_cell = redraw.get("before_cell", lambda figure: "")
    code = [cell for cell in page.notebook.cells if cell.cell_type == "code"]
    tagged = [
        (cell, ran)
        for cell, ran in zip(code, executed.cells, strict=True)
        if "figure" in cell.metadata.get("tags", [])
        and name_of(cell) not in redraw.get("NOT_IN_BUNDLE", ())
    ]
    bundle = built.outputs[f"{lesson}/{name}"] / "cpu"
    sources = [imports(page), NAMES.format(folder=str(bundle))]
    sources += [FURTHER.format(script=str(script))] if redraw else []
    sources += [f"{before_cell(name_of(cell))}\n{cell.source}" for cell, _ in tagged]
    redrawn = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(s) for s in sources])
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    NotebookClient(redrawn, kernel_name="python3", timeout=120).execute()
    drawn = svgs([ran for _, ran in tagged])
    assert len(drawn) == len(tagged) >= 1
    assert svgs(redrawn.cells) == drawn
