"""The engine's compiler: searches that are spared, and kernels that are saved before the end."""

import importlib
import inspect
import sys
from types import ModuleType

import pytest

from robo_genesis.sim.compiler import spare_searches
from robo_genesis.sim.fresh_process import run_python

COMPILES = """\
import sys
from pathlib import Path
import quadrants as qd
from robo_genesis.sim.compiler import save_kernels

@qd.kernel
def twice(a: int) -> int:
    return 2 * a

save_kernels()  # of an engine that is not started there are none
qd.init(arch=qd.cpu, offline_cache_file_path=sys.argv[1])
twice(2)
found = lambda: len([*Path(sys.argv[1]).rglob("*.qdc")])
before = found()
save_kernels()
print(before, found() > before)
"""


class Searched(ModuleType):
    """A module that counts how often a search of all modules reaches it."""

    times = 0

    def __getattr__(self, name):
        type(self).times += name == "__file__"
        raise AttributeError(name)


def test_the_caller_of_a_declaration_is_found_without_a_search_of_all_modules(
    tmp_path, monkeypatch
):
    """A module asks as the engine's compiler does where a kernel is declared."""
    monkeypatch.setattr(inspect, "modulesbyfile", dict(inspect.modulesbyfile))
    inspect.modulesbyfile.pop("<frozen importlib._bootstrap>", None)
    spare_searches()
    monkeypatch.setitem(sys.modules, "searched", Searched("searched"))
    monkeypatch.syspath_prepend(tmp_path)
    code = "import inspect, sys\n\nCALLER = inspect.getframeinfo(sys._getframe(1))\n"
    (tmp_path / "declares.py").write_text(code, "utf8")
    found = importlib.import_module("declares").CALLER
    monkeypatch.delitem(sys.modules, "declares")
    assert (found.filename, Searched.times) == ("<frozen importlib._bootstrap>", 0)


@pytest.mark.engine
def test_kernels_are_saved_while_the_engine_runs(tmp_path):
    (script := tmp_path / "compiles.py").write_text(COMPILES)  # the compiler reads its source
    said = run_python([str(script), str(tmp_path / "cache")], {})
    assert said.splitlines()[-1] == "0 True"
