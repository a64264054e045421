"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

from types import SimpleNamespace

import numpy as np
import pytest
from lessons.body_runs import make_drop
from lessons.exercise_cells import solutions
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l02 import exercises, spec

OURS = solutions("l02")["record"]


def scene_with(rho=500, size=0.1, height=0.5, ground=True, fixed=False, **settings):
    """Return a function that makes the scene, with mistakes."""

    def make(gs):
        box = FakeBody(rho * size**3, height, size / 2 if ground else -np.inf, fixed)
        return FakeScene(box, **settings), box

    return make


def without_reset(scene, box, steps):
    return OURS(SimpleNamespace(step=scene.step, reset=lambda: None), box, steps)


CASES = {
    "scene": {
        "right": scene_with(),
        "one substep": scene_with(substeps=1),
        "the default density": scene_with(rho=600),
        "the underside at half a metre": scene_with(height=0.55),
        "no ground": scene_with(ground=False),
        "fixed": scene_with(fixed=True),
    },
    "record": {
        "right": OURS,
        "without the first state": lambda *of: [values[1:] for values in OURS(*of)],
        "without a reset": without_reset,
        "speed downwards": lambda *of: (
            OURS(*of)[0],
            [-speed for speed in OURS(*of)[1]],
        ),
    },
}


@pytest.mark.parametrize(
    ("name", "how"), [(n, how) for n, of in CASES.items() for how in of]
)
def test_only_the_right_solution_passes(name, how):
    scene, box = scene_with()(None)
    scene.step()  # the student's record starts from any state
    more = {
        "scene": (None, spec.BASELINE),
        "record": (scene, box, make_drop(spec.BASELINE)),
    }
    check = getattr(exercises, name)(CASES[name][how], *more[name])
    assert check.passed == (how == "right"), check.detail
