"""Evidence keys cover what a page can load by its imports; a build compares what it does load."""

import ast

import pytest

from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.lessons import LESSONS
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.sources import Tree, measuring_modules
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
