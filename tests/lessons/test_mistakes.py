"""Our solutions pass the tests of a lab's functions, and fail with each typical mistake."""

import re
import runpy
from importlib import import_module
from pathlib import Path

import pytest
from lessons.exercise_cells import page_of, undetected
from robot_runs import LINKS, answer, driven

from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.arm.joint_control import ControlCase

MISTAKES = {
    path.parent.name: runpy.run_path(str(path))["MISTAKES"]
    for path in sorted(Path(__file__).parent.glob("*/mistakes.py"))
}
FUNCTIONS = [(lesson, name) for lesson, of in MISTAKES.items() for name in of]


@pytest.fixture(scope="module")
def trace():
    """A reach, with which a test of a kinematic chain compares."""
    found = answer([0.45, 0.0, 0.35], Q_START, 100)
    return driven(ControlCase(q_target=found.q, steps=180), LINKS)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize(("lesson", "name"), FUNCTIONS)
def test_our_solution_passes_and_each_mistake_is_found(lesson, name, trace):
    code = "\n".join(cell.source for cell in page_of(lesson, "lab").notebook.cells)
    call = re.search(rf"page\.test\(exercises\.(\w+), {name}(, trace)?\)", code)
    test = getattr(import_module(f"robo_genesis.lessons.{lesson}.exercises"), call[1])
    given = [trace] if call[2] else []
    assert undetected(test, MISTAKES[lesson][name], lesson, name, *given) == []
