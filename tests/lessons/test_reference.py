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
READS = re.compile(r"camera\.|\.get_|\.detect_collision|\.inverse_kinematics")


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
    robot, dofs = lab.franka, lab.joints.dofs_idx_local
    hand = robot.get_link("hand")
    names = vars(lab) | {"robot": robot, "body": robot, "dofs": dofs, "link": hand}
    names |= {"pos": hand.get_pos(), "quat": hand.get_quat()}
    names |= {"solver": lab.scene.rigid_solver, "geoms": [0, 1]}
    height, width, _ = lab.camera.render()[0].shape
    sizes = {"n": 9, "q": 9, "L": robot.n_links, "g": 2, "H": height, "W": width}
    looked_at = 0
    for call, shape in ROWS:
        single = "`" not in call and "…" not in call
        if not shape or "B" in shape or not single or not READS.search(call):
            continue
        found = np.shape(eval(call, names))
        declared = [sizes.get(part, part) for part in shape.split(", ")]
        known = zip(found, declared, strict=True)
        assert all(str(one) == str(said) or said == "k" for one, said in known), call
        looked_at += 1
    assert looked_at > 20
