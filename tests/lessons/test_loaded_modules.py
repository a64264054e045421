"""Evidence keys cover what a page can load by its imports, and what the run of a lab does load."""

import ast
import json
import os
import shutil
import subprocess
import sys

import pytest

from robo_genesis.core.project import BOOK, CACHE, ROOT
from robo_genesis.lessons import LESSONS
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.execute import kernel_environment
from robo_genesis.pipeline.pages.sources import Tree, lesson_modules, measuring_modules
from robo_genesis.pipeline.pages.syntax import PACKAGE

IMPORTING = {"__import__", "eval", "exec", "exec_module", "import_module", "run_module", "run_path"}
MADE_NAMES = {
    "pipeline/html/sphinx_process.py": "importlib.import_module(name)",
    "core/shown.py": "import_module(place)",
    "core/declaration.py": "import_module(module)",
    "lessons/__init__.py": "import_module(f'{__name__}.{name}')",
}
"""Where the package imports by a name made at run time: extensions of Sphinx, the module of a shown
function, and the modules of lessons, which the keys have by their folders."""

SHORT = "l02"
"""The lesson with the shortest lab, which runs each time."""
assert SHORT in LESSONS

LABS = {page.lesson: page for page in find_pages(BOOK) if page.page == "lab"}

RUN = """
import json, os, sys
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
for cell in json.load(sys.stdin):
    shell.run_cell(cell).raise_error()
names = [name for name in sys.modules if name.split(".")[0] == "robo_genesis"]
json.dump(names, open("loaded.json", "w"))
os._exit(0)
"""


def loaded_modules(lab, tmp_path):
    """Run the cells of a lab in a process of its own, which has the package without other lessons.

    Where the registry finds all lessons, it loads what they use, which hides what this one uses.
    """
    others = [name for name in LESSONS if name != lab.lesson]
    left_out = shutil.ignore_patterns("__pycache__", *others)
    shutil.copytree(ROOT / PACKAGE, tmp_path / PACKAGE, ignore=left_out)
    for name in ("pyproject.toml", "requirements.lock"):
        shutil.copy(ROOT / name, tmp_path)
    settings = kernel_environment(ROOT, CACHE, "a test", ROBO_GENESIS_RENDER="0")
    cells = [cell.source for cell in lab.notebook.cells if cell.cell_type == "code"]
    done = subprocess.run(
        [sys.executable, "-c", RUN],
        input=json.dumps(cells),
        cwd=tmp_path,
        env=os.environ | settings | {"PYTHONPATH": str(tmp_path), "MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads((tmp_path / "loaded.json").read_text())


SLOWER = [pytest.param(name, marks=pytest.mark.slow) for name in LESSONS if name != SHORT]


@pytest.mark.engine
@pytest.mark.parametrize("lesson", [SHORT, *SLOWER])
def test_a_run_loads_only_modules_that_the_keys_know(lesson, tmp_path):
    lab = LABS[lesson]
    loaded = set(loaded_modules(lab, tmp_path))
    reached = Tree().closure([*lesson_modules(lab.lesson, ROOT), *lab.code.imports])
    assert loaded <= reached.keys()


@pytest.mark.parametrize("page", find_pages(BOOK), ids=lambda page: f"{page.lesson}-{page.page}")
def test_whatever_a_page_may_import_is_known_to_its_key(page):
    """Except what only judges a finished run: its functions import what some lessons need."""
    imports = page.code.imports
    reached = Tree().closure(
        [f"{PACKAGE}.lessons.{page.lesson}", *imports],
        enter=lambda name, path: not name.endswith("laws"),
    )
    own = (f"{PACKAGE}.sim.", f"{PACKAGE}.lessons.{page.lesson}.")
    computing = {
        name.removeprefix(f"{PACKAGE}.")
        for name, path in reached.items()
        if name.startswith(own) and Tree().measures(name, path)
    }
    assert {f"lessons.{page.lesson}.metrics", "sim.session"} <= computing
    assert computing <= measuring_modules(page.lesson, imports).keys()


def test_imports_are_statements_or_have_a_known_name():
    package = ROOT / PACKAGE
    found = {
        path.relative_to(package).as_posix(): calls
        for path in package.rglob("*.py")
        if (calls := made_imports(path.read_text("utf8")))
    }
    assert found == {file: [call] for file, call in MADE_NAMES.items()}
    cells = [source for page in find_pages(BOOK) for source in page.code.sources]
    assert [call for source in cells for call in made_imports(source)] == []


@pytest.mark.parametrize("lesson", LESSONS)
def test_a_lesson_loads_on_demand_from_its_own_folder(lesson):
    tree = ast.parse((ROOT / PACKAGE / "lessons" / lesson / "__init__.py").read_text("utf8"))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    loading = [call for call in calls if ast.unparse(call.func).endswith("on_demand")]
    assert all(ast.unparse(call.args[0]) == "__name__" for call in loading)


def made_imports(source):
    """Return what imports other than by a statement or by the name of a foreign module."""
    return [ast.unparse(node) for node in ast.walk(ast.parse(source)) if is_made(node)]


def is_made(node):
    if isinstance(node, ast.ImportFrom):
        return any(alias.name in IMPORTING and alias.asname for alias in node.names)
    if not isinstance(node, ast.Call) or ast.unparse(node.func).split(".")[-1] not in IMPORTING:
        return False
    match node.args:
        case [ast.Constant(value=str(name))] if not name.startswith((".", PACKAGE)):
            return ast.unparse(node.func).split(".")[-1] != "import_module"
    return True
