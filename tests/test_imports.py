"""Only `sim` imports engines, and no module does while it is loaded itself."""

import ast
import json
import subprocess
import sys
from pathlib import Path

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
            return [str(a.value) for a in node.args if isinstance(a, ast.Constant)]
    return []


def test_the_engine_is_imported_by_sim_alone():
    found = {False: set(), True: set()}
    for path in MODULES:
        nodes = ast.walk(ast.parse(path.read_text("utf8")))
        names = {name.split(".")[0] for node in nodes for name in imported(node)}
        found["sim" in path.relative_to(PACKAGE).parts] |= names & ENGINE
    assert found == {False: set(), True: ENGINE}


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
    drawing = [name for name in LESSONS if (PACKAGE / "lessons" / name / "plots.py").is_file()]
    names = ", ".join(drawing)
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
    assert modules.count("plots.py") == len(drawing)
