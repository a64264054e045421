"""The evidence key of a lab covers what a run really loads, whatever the import statements say."""

import json
import os
import shutil
import subprocess
import sys

import pytest

from robo_genesis.build.execute import kernel_environment
from robo_genesis.core.project import BOOK, CACHE, ROOT
from robo_genesis.lessons.book_pages import cell_sources, find_pages
from robo_genesis.lessons.registry import LESSONS
from robo_genesis.lessons.sources import (
    PACKAGE,
    computes,
    import_closure,
    imports_of,
    measuring_modules,
)

pytestmark = pytest.mark.engine

SHORTER = {
    "l06": ("throughput.py", "Protocol((1, 4, 16, 64, 256, 1024))", "Protocol((1, 4))"),
}
"""By lesson: a module, a protocol in it, and a shorter one, with which the lab loads the same."""

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


@pytest.fixture(params=LESSONS)
def lab(request):
    return LABS[request.param]


def loaded_modules(lab, tmp_path):
    """Run the cells of a lab in a process of its own, which has the package without other lessons.

    Where the registry finds all lessons, it loads what they use, which hides what this one uses.
    """
    others = [name for name in LESSONS if name != lab.lesson]
    left_out = shutil.ignore_patterns("__pycache__", *others)
    shutil.copytree(ROOT / PACKAGE, tmp_path / PACKAGE, ignore=left_out)
    if lab.lesson in SHORTER:
        name, long, short = SHORTER[lab.lesson]
        module = tmp_path / PACKAGE / "lessons" / lab.lesson / name
        text = module.read_text("utf8")
        assert f" = {long}\n" in text
        module.write_text(text.replace(long, short), "utf8")
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


def test_a_run_loads_only_modules_that_the_keys_know(lab, tmp_path):
    loaded = set(loaded_modules(lab, tmp_path))
    imports = imports_of(cell_sources(lab))
    reached = import_closure([f"{PACKAGE}.lessons.{lab.lesson}", *imports])
    assert loaded <= reached.keys()
    computing = {
        name.removeprefix(f"{PACKAGE}.")
        for name in loaded
        if name.startswith((f"{PACKAGE}.sim.", f"{PACKAGE}.lessons.{lab.lesson}."))
        and computes(name, reached[name])
    }
    assert {f"lessons.{lab.lesson}.metrics", "sim.session"} <= computing
    assert computing <= measuring_modules(lab.lesson, imports).keys()
