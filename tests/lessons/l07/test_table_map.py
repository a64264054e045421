"""The map of the table follows from the arrays, and says which tests the object passes."""

import pytest
from lessons.changed_runs import failed, reading, shift, trace

from robo_genesis.lessons.l07 import explorer, table_map
from robo_genesis.sim.arm.kinematics import HAND

MIDDLE = len(table_map.CELLS) // 2
GRASP = (2 * MIDDLE + 2, HAND, 2)


def test_each_cell_shows_its_own_answer(scenes):
    data = explorer.explored(scenes)
    cells = [cell for row in data["maps"][0]["rows"][::-1] for cell in row["cells"]]
    for number, (cell, place) in enumerate(
        zip(cells, table_map.CASE.places, strict=True)
    ):
        assert cell["answer"] == 2 * number + 2
        assert data["postures"]["table"][cell["answer"] - 1][:2] == pytest.approx(place)
        assert len(cell["values"]) == len(data["columns"])
    assert cells[MIDDLE]["sentence"] == "Passes all four tests."
    assert cells[-1]["state"] == "refused"
    assert cells[MIDDLE]["numbers"][0] == 4 > cells[-1]["numbers"][0]


# A change, and the verdict on the cell in the middle that it breaks
SPOILED = {
    "another count": (reading("table_reached", str(MIDDLE), 1), "reachable"),
    "low fingertips": (trace("table", link_pos=shift(GRASP, -0.05)), "reachable"),
    "the bowl in the way": (reading("table_free", str(MIDDLE), 1), "graspable"),
    "no picture": (reading("view_wrist", "intrinsics_02", -9e3), "wrist"),
    "a hand elsewhere": (trace("table", link_pos=shift(GRASP, 1e-3)), ""),
}


@pytest.mark.parametrize("name", SPOILED)
def test_a_verdict_and_the_check_of_the_map(scenes, name):
    spoil, verdict = SPOILED[name]
    run = spoil(scenes)
    assert failed(run) == {"map_follows"}
    assert not verdict or not table_map.verdicts(run)[verdict][MIDDLE]
