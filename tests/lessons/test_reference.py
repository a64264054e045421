"""The tables of calls in lectures: shapes are the engine's, and no call of a script is missing."""

import re

import numpy as np
import pytest

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.pages.book import code_cells, read_notebook
from robo_genesis.site.course.sizes import HIDDEN

LECTURES = sorted(
    path for name in ("lecture", "motion") for path in BOOK.glob(f"lessons/*/{name}.md")
)
ROWS = re.findall(
    r"^\| `([^|]+)` \| (?:\(([^|]*?),?\))?",
    "\n".join(path.read_text() for path in LECTURES),
    re.MULTILINE,
)
CALL = re.compile(
    r"\.((?:get|set|control)_\w+|add_\w+|detect_collision|inverse_kinematics|render|reset)\("
)
# Calls of one row that change nothing.
READ = re.compile(r"camera\.[^`]+$|\w+\.(?:get_|detect_|inverse_)[^`]+$")


@pytest.mark.parametrize("path", LECTURES, ids=lambda path: path.parent.name)
def test_each_call_of_the_visible_code_is_in_a_table(path):
    visible = "\n".join(
        cell.source
        for cell in code_cells(read_notebook(path))
        if not HIDDEN.intersection(cell.metadata.get("tags", ()))
    )
    declared = CALL.findall("\n".join(call for call, _ in ROWS))
    assert {*CALL.findall(visible)} - {*declared} == set()


@pytest.mark.engine
def test_a_read_has_the_shape_in_the_table(lab):
    robot = lab.franka
    hand = robot.get_link("hand")
    names = vars(lab) | {"robot": robot, "body": robot, "link": hand}
    names |= {"dofs": lab.joints.dofs_idx_local, "solver": lab.scene.rigid_solver}
    names |= {"pos": hand.get_pos(), "quat": hand.get_quat(), "geoms": [0, 1]}
    sizes = {"n": 9, "L": robot.n_links}
    reads = [(call, shape) for call, shape in ROWS if shape and READ.match(call)]
    reads = [(call, shape.split(", ")) for call, shape in reads if "B" not in shape]
    assert len(reads) > 20
    for call, declared in reads:
        found = np.shape(eval(call, names))
        for name, size in zip(declared, found, strict=True):
            assert name in {*"gkqHW"} or str(sizes.get(name, name)) == str(size), call
