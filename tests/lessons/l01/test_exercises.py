"""The tests of the student's functions: our solutions pass, and typical wrong ones fail."""

from functools import partial

import pytest
from lessons.exercise_cells import solutions
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l01 import exercises, spec


def fall(scene, sphere, steps, *, reset=True, late=True):
    """Return the last height; other values of the last arguments make mistakes."""
    if reset:
        scene.reset()
    kept = sphere.get_pos()[2].item()
    for _ in range(steps):
        scene.step()
    return sphere.get_pos()[2].item() if late else kept


CASES = {
    "right": solutions("l01")["fall"],
    "no reset": partial(fall, reset=False),
    "read too early": partial(fall, late=False),
    "one step more": lambda scene, sphere, steps: fall(scene, sphere, steps + 1),
}


@pytest.mark.parametrize("how", CASES)
def test_only_the_right_solution_passes(how):
    sphere = FakeBody(1.0, spec.BASELINE.height)
    scene = FakeScene(sphere, dt=spec.BASELINE.dt, substeps=spec.BASELINE.substeps)
    check = exercises.fall(CASES[how], scene, sphere)
    assert check.passed == (how == "right"), check.detail
