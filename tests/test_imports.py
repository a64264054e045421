"""Only `sim` imports engines, and only inside functions."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

import robo_genesis
from robo_genesis.lessons import LESSONS

PACKAGE = Path(robo_genesis.__file__).parent
MODULES = sorted(PACKAGE.rglob("*.py"))
ENGINE = {"genesis", "quadrants", "mujoco"}


def imported(node):
    """Names of the modules that one node imports, by statement or by call."""
    match node:
        case ast.Import():
            return [alias.name for alias in node.names]
        case ast.ImportFrom(module=str(module), level=0):
            return [module]
        case ast.Call(
            func=ast.Attribute(attr="import_module") | ast.Name(id="import_module" | "__import__")
        ):
            return [a.value for a in node.args if isinstance(a, ast.Constant)]
    return []


def engine_imports(tree, inside=False):
    """Yield (line, whether inside a function) of every import of the engine."""
    for node in ast.iter_child_nodes(tree):
        if any(str(name).split(".")[0] in ENGINE for name in imported(node)):
            yield node.lineno, inside
        yield from engine_imports(
            node, inside or isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        )


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_the_engine_is_imported_by_few_and_inside_functions(path):
    found = list(engine_imports(ast.parse(path.read_text("utf8"))))
    if "sim" not in path.relative_to(PACKAGE).parts:
        assert found == []
    assert [line for line, inside in found if not inside] == []


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("import genesis as gs", [(1, False)]),
        ("from genesis.utils import geom", [(1, False)]),
        ("def f():\n    import quadrants", [(2, True)]),
        ("class C:\n    gs = importlib.import_module('genesis')", [(2, False)]),
        ("def f():\n    return importlib.import_module('genesis.x')", [(2, True)]),
        ("x = __import__('genesis')", [(1, False)]),
        ("from robo_genesis import genesis_notes", []),
        ("import genesistools", []),
    ],
)
def test_the_search_finds_every_form(source, found):
    assert list(engine_imports(ast.parse(source))) == found


BLOCKED = """
import importlib, json, sys
for name in ("genesis", "quadrants", "torch", "mujoco"):
    sys.modules[name] = None
failed = {}
for name in json.loads(sys.argv[1]):
    try:
        importlib.import_module(name)
    except Exception as error:
        failed[name] = repr(error)
print(json.dumps(failed))
"""


def test_every_module_imports_without_the_engine():
    names = [
        ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
        for path in MODULES
    ]
    done = subprocess.run(
        [sys.executable, "-c", BLOCKED, json.dumps(names)],
        capture_output=True,
        text=True,
        check=True,
        cwd=PACKAGE.parent,
    )
    assert json.loads(done.stdout.splitlines()[-1]) == {}


def test_a_verification_imports_no_plotting():
    found = (
        "import sys, robo_genesis.pipeline.bundles.verify as _; print('matplotlib' in sys.modules)"
    )
    names = ", ".join(LESSONS)
    plots = f"from robo_genesis.lessons import {names}; print([x.plots for x in ({names})])"
    done = subprocess.run(
        [sys.executable, "-c", f"{found}; {plots}"],
        capture_output=True,
        text=True,
        check=True,
        cwd=PACKAGE.parent,
    )
    drawn, modules = done.stdout.splitlines()
    assert drawn == "False"
    assert modules.count("plots.py") == len(LESSONS)
