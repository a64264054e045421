"""What the lab says about episodes is complete for each outcome."""

import numpy as np
import pytest
from lessons.changed_runs import put, trace
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l08 import spec, student

SOLVED, EXACT, ALL = solutions("l08"), spec.EXACT, slice(None)


def test_the_lab_passes_its_checks(lab):
    assert [one for one in lab.outcomes() if not one.passed] == []


@pytest.mark.filterwarnings(
    "ignore:Mean of empty slice", "ignore:invalid value encountered"
)
@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        (
            {},
            [
                "64 of 64 episodes",
                "94.3 to 100.0 %",
                "No episode fails.",
                "11.7 N",
            ],
        ),
        (
            {"touches": put((-1, 5), 1)},
            ["63 of 64", "first: 1 at “released”."],
        ),
        (
            {"force": put((ALL, ALL, 0), 0)},
            ["0 of 64", "first: 64 at “held”.", "are not measured"],
        ),
        ({"phase": put(ALL, 8)}, ["first: 64 at “planned”.", "are not measured"]),
    ],
)
def test_each_outcome_has_words(lab, arrays, said):
    found = student.conclusions(trace("exact", **arrays)(lab))
    assert all(words in found for words in said), found


def test_the_student_s_numbers_stand_beside_the_course_s(lab):
    given = lab.traces["exact"], EXACT
    table = student.counted(SOLVED["rungs"], *given).splitlines()
    assert [line.split()[1:] for line in table[1:8]] == [["64", "64"]] * 7
    assert (
        student.rate(SOLVED["rungs"], SOLVED["wilson"], *given).count("94.3 to 100.0 %")
        == 2
    )
    assert student.slide(SOLVED["creep"], *given).count("1.60 mm/s") == 2
    assert "differ in the episodes" in student.counted(lambda *arrays: 3, *given)
    none = trace("exact", force=put(ALL, 0))(lab).traces["exact"]
    assert "No episode is carried" in student.slide(SOLVED["creep"], none, EXACT)


def test_the_student_s_expert_is_the_course_s():
    mine = student.waypoints(SOLVED["grasp_pose"], EXACT)
    assert np.allclose(mine, EXACT.waypoints, rtol=0, atol=1e-12)
    expert = student.machine(SOLVED["ended"])(
        EXACT, np.zeros((9, 64, 7)), np.ones(64, bool)
    )
    q, expert.since[:2] = np.zeros((64, 9)), 9
    expert.phase[:] = np.arange(64) % 8
    assert expert.ends(q, q).tolist() == super(type(expert), expert).ends(q, q).tolist()


@pytest.mark.parametrize("returned", [None, "yes", True])
def test_an_end_that_is_no_truth_value_for_each_environment_is_named(returned):
    def ended(*given):
        return returned

    goals = np.zeros((9, 2, 7))
    expert = student.machine(ended)(EXACT, goals, np.ones(2, bool))
    with pytest.raises(TypeError, match=r"ended returned .*, valid are 2 truth values"):
        expert.act(np.zeros((2, 9)), np.zeros((2, 9)))
