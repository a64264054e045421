"""No module imports an engine while it is loaded itself."""

import json
import subprocess
import sys

from robo_genesis.core.project import ROOT

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
        ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for path in sorted((ROOT / "robo_genesis").rglob("*.py"))
    ]
    command = [sys.executable, "-c", BLOCKED, json.dumps(names)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert json.loads(done.stdout.splitlines()[-1]) == {}
