"""Work that the engine is spared: the answers of Python's library and of trimesh stay the same."""

import gc
import importlib
import inspect
import sys
import textwrap
import traceback
from collections import Counter
from types import ModuleType

import numpy as np
import pytest
from trimesh import Trimesh, creation
from trimesh.voxel.creation import voxelize

from robo_genesis.sim.compiler import FRAMES, OBJECTS, spare_repeated_work

IMPORT = "<frozen importlib._bootstrap>"


@pytest.fixture
def spared(monkeypatch):
    """Spare this process, for one test; return how often the library itself was asked."""
    asked, wrap, lines = Counter(), textwrap.TextWrapper.wrap, inspect.getsourcelines
    monkeypatch.setattr(inspect, "modulesbyfile", dict(inspect.modulesbyfile))
    inspect.modulesbyfile.pop(IMPORT, None)

    def counted(name, function):
        return lambda *given, **how: (asked.update([name]), function(*given, **how))[1]

    monkeypatch.setattr(Trimesh, "voxelized", counted("covered", Trimesh.voxelized))
    monkeypatch.setattr(traceback, "extract_stack", traceback.extract_stack)
    monkeypatch.setattr(textwrap.TextWrapper, "wrap", counted("wrap", wrap))
    monkeypatch.setattr(inspect, "getsourcelines", counted("lines", lines))
    before = gc.get_threshold()
    try:
        gc.set_threshold(700)
        for _ in range(2):  # the second time changes nothing
            spare_repeated_work()
        assert gc.get_threshold() == (OBJECTS, *before[1:])
        yield asked
    finally:
        gc.set_threshold(*before)


@pytest.mark.parametrize("already", [0, 1_000_000])
def test_python_looks_for_unused_objects_no_more_often_than_before(spared, already):
    gc.set_threshold(already)
    inspect.modulesbyfile.pop(IMPORT)
    spare_repeated_work()
    assert gc.get_threshold()[0] == already


def test_without_trimesh_the_rest_is_spared(spared, monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", None)  # as if it were not installed
    inspect.modulesbyfile.pop(IMPORT)
    before = inspect.getsourcelines
    spare_repeated_work()
    assert inspect.modulesbyfile[IMPORT] == ""
    assert inspect.getsourcelines is not before


class Searched(ModuleType):
    """A module that counts how often a search of all modules reaches it."""

    times = 0

    def __getattr__(self, name):
        type(self).times += name == "__file__"
        raise AttributeError(name)


def test_a_declaration_s_caller_is_found_without_a_search_of_modules(
    spared, tmp_path, monkeypatch
):
    """A module asks as the engine's compiler does where a kernel is declared."""
    monkeypatch.setitem(sys.modules, "searched", Searched("searched"))
    monkeypatch.syspath_prepend(tmp_path)
    code = "import inspect, sys\n\nCALLER = inspect.getframeinfo(sys._getframe(1))\n"
    (tmp_path / "declares.py").write_text(code, "utf8")
    found = importlib.import_module("declares").CALLER
    monkeypatch.delitem(sys.modules, "declares")
    assert (found.filename, Searched.times) == (IMPORT, 0)


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({"width": 20}, ["        place of the", "hand and the fingers"]),
        ({"width": 60}, ["        place of the hand and the fingers"]),
        ({"width": 20, "tabsize": 2}, ["  place of the hand", "and the fingers"]),
    ],
)
def test_a_line_is_wrapped_once_for_each_setting(spared, settings, expected):
    for _ in range(3):
        found = textwrap.TextWrapper(**settings).wrap(
            "\tplace of the hand and the fingers"
        )
        assert found == expected
        found.append("changed by the caller")
    assert spared["wrap"] == 1


class Shouted(textwrap.TextWrapper):
    """A wrapper with a step of its own, and with a setting that has no hash."""

    def __init__(self):
        super().__init__()
        self.own = []

    def _split(self, text):
        return super()._split(text.upper())


def test_a_wrapper_of_another_class_is_left_alone(spared):
    assert Shouted().wrap("place of the hand") == ["PLACE OF THE HAND"]


def test_the_source_of_a_function_is_searched_once_and_that_of_anything_else_each_time(
    spared,
):
    for _ in range(2):
        source, line = inspect.getsourcelines(textwrap.dedent)
        assert (source[0], line) == (
            "def dedent(text):\n",
            textwrap.dedent.__code__.co_firstlineno,
        )
        source.clear()
        assert inspect.getsource(Searched).startswith("class Searched")
    assert spared["lines"] == 3


def test_a_function_whose_code_was_replaced_is_read_again(spared):
    def first():
        return 1

    def second():
        return 2

    assert "return 1" in inspect.getsource(first)
    first.__code__ = second.__code__
    assert "return 2" in inspect.getsource(first)


def test_equal_surfaces_are_covered_once_for_each_size_of_the_cubes_and_others_anew(
    spared,
):
    boxes = [creation.box((0.2, 0.1, width)) for width in (0.1, 0.1, 0.3)]
    found = [
        box.voxelized(pitch=pitch).matrix for box in boxes for pitch in (0.02, 0.05)
    ]
    assert spared["covered"] == 4
    assert np.array_equal(found[0], found[2])
    assert np.array_equal(found[1], found[3])
    shapes = [matrix.shape for matrix in found]
    assert len({*shapes}) == 4
    points = boxes[0].voxelized(pitch=0.02).points
    assert np.array_equal(points, voxelize(boxes[0], 0.02).points)
    boxes[0].voxelized(pitch=0.02).apply_scale(2)
    assert np.array_equal(boxes[1].voxelized(pitch=0.02).points, points)
    for settings in ({"method": "ray"}, {"max_iter": 9}):
        box = boxes[0].voxelized(0.02, **settings)
        assert np.array_equal(box.points, boxes[0].voxelized(0.02, **settings).points)
    assert spared["covered"] == 8


def calls(depth):
    """Ask for the calls that lead here, below `depth` more."""
    return calls(depth - 1) if depth else traceback.extract_stack()


@pytest.mark.parametrize(
    ("asks", "short"), [("a_page", False), ("quadrants.lang.util", True)]
)
def test_the_engine_alone_gets_the_last_calls_only(spared, monkeypatch, asks, short):
    monkeypatch.setitem(globals(), "__name__", asks)
    found = calls(20)
    assert {(call.name, call.lineno) for call in found[-FRAMES:]} == {
        ("calls", found[-1].lineno)
    }
    assert (len(found) == FRAMES) == short
