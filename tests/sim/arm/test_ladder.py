"""Which rung an episode of a moved object is lost at, by what happened to the object."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import put, shift, with_fields

from robo_genesis.core.trace import Episodes
from robo_genesis.lessons.l08.spec import EXACT as CASE
from robo_genesis.sim.arm import ladder

RUNGS = ["held", "lifted", "carried", "released", "contained", "resting"]
HELD, OVER, END = slice(10, 26), slice(20, 26), slice(30, None)


@pytest.fixture
def placed():
    """An episode: held from sample 10, over the bowl from 20, in it from 26, at rest from 30."""
    place, touched = np.tile([0.5, 0.0, 0.035], (40, 1, 1)), np.zeros((40, 1))
    place[12:26, :, 2] = 0.155
    place[20:, :, :2] = CASE.bowl_at
    place[26:, :, 2] = 0.045
    touched[HELD] = 1
    return Episodes(
        t=np.arange(40) * CASE.dt,
        phase=np.zeros((40, 1)),
        q=np.zeros((40, 1, 9)),
        object_pos=place,
        object_quat=np.tile([1.0, 0, 0, 0], (40, 1, 1)),
        force=np.repeat(10 * touched[..., None], 2, axis=2),
        touches=touched,
    )


TILTED = [np.cos(0.31), np.sin(0.31), 0, 0]  # by 36° about x


def of_x(index):
    return (index, 0, 0)


def of_z(index):
    return (index, 0, 2)


FATES = {
    "placed": (None, {}),
    "held again by one finger on the way": (None, {"force": put((15, 0, 1), 0)}),
    "touched before the end": (None, {"touches": put(-2, 1)}),
    "beside the axis": (None, {"object_pos": shift(of_x(END), 0.059)}),
    "moved by nearly nothing": (None, {"object_pos": shift(of_x(-1), 1.9e-4)}),
    "pressed by one finger alone": ("held", {"force": put((HELD, 0, 1), 0)}),
    "hardly pressed": ("held", {"force": put(HELD, 0.09)}),
    "pushed in": ("lifted", {"object_pos": put(of_z(slice(26)), 0.035)}),
    "lifted too little": ("lifted", {"object_pos": put(of_z(slice(12, 26)), 0.084)}),
    "thrown": ("lifted", {"force": put(slice(12, None), 0)}),
    "dropped on the way into the bowl": ("carried", {"force": put(OVER, 0)}),
    "held beside the bowl": ("carried", {"object_pos": shift(of_x(OVER), 0.061)}),
    "tilted below the rim": (
        "carried",
        {"object_pos": put(of_z(OVER), 0.09), "object_quat": put(OVER, TILTED)},
    ),
    "touched at the end": ("released", {"touches": put(-1, 1)}),
    "beside the bowl": ("contained", {"object_pos": shift(of_x(END), 0.061)}),
    "on the rim": ("contained", {"object_pos": put(of_z(END), 0.076)}),
    "rolling": ("resting", {"object_pos": shift(of_x(-1), 2.1e-4)}),
    "rolling till shortly before the end": (
        "resting",
        {"object_pos": shift(of_x(slice(-4, None)), 1e-3)},
    ),
}


@pytest.mark.parametrize("fate", FATES)
def test_an_episode_is_lost_at_its_rung(placed, fate):
    lost, arrays = FATES[fate]
    passed = ladder.of_object(with_fields(placed, arrays), CASE)
    assert [*passed] == RUNGS
    expected = len(RUNGS) if lost is None else RUNGS.index(lost)
    assert ladder.count(passed).tolist() == [expected]


def test_rungs_after_the_first_that_is_lost_do_not_count():
    passed = {
        "a": [True, True, False],
        "b": [True, False, True],
        "c": [True, True, True],
    }
    assert ladder.count(passed).tolist() == [3, 1, 0]


@pytest.mark.parametrize("shape", ["cylinder", "box"])
def test_the_lowest_point_of_a_tilted_object(placed, shape):
    half = np.pi / 8  # a turn by 45° about x
    tilted = replace(
        placed,
        object_quat=np.tile([np.cos(half), np.sin(half), 0, 0], (40, 1, 1)),
        object_pos=np.zeros((40, 1, 3)),
    )
    corner = -(0.025 + 0.035) * np.sqrt(0.5)
    found = ladder.lowest(tilted, replace(CASE, shape=shape))
    assert found == pytest.approx(np.full((40, 1), corner))
