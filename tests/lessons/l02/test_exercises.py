"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

import numpy as np
import pytest
from lessons.body_runs import make_drop
from lessons.exercise_cells import undetected
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l02 import exercises, spec


def scene_with(rho=500, size=0.1, height=0.5, ground=True, fixed=False, **settings):
    """Return a function that makes the scene, with mistakes."""

    def make(gs):
        box = FakeBody(rho * size**3, height, size / 2 if ground else -np.inf, fixed)
        return FakeScene(box, **settings), box

    return make


SCENES = {
    "right": scene_with(),  # ours runs in the engine, when its page is executed
    "one substep": scene_with(substeps=1),
    "the default density": scene_with(rho=600),
    "the underside at half a metre": scene_with(height=0.55),
    "no ground": scene_with(ground=False),
    "fixed": scene_with(fixed=True),
}


@pytest.mark.parametrize("how", SCENES)
def test_only_the_right_scene_passes(how):
    check = exercises.scene(SCENES[how], None, spec.BASELINE)
    assert check.passed == (how == "right"), check.detail


RECORDS = {
    "    scene.reset()\n": [""],
    "return heights, speeds": [
        "return heights[1:], speeds[1:]",
        "return heights, [-speed for speed in speeds]",
    ],
}


def test_each_mistake_in_a_record_is_found():
    scene, box = scene_with()(None)
    scene.step()  # the student's record starts from any state
    given = scene, box, make_drop(spec.BASELINE)
    assert undetected(exercises.record, RECORDS, "l02", "record", *given) == []
