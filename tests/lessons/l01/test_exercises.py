"""The test of the student's fall: our solution passes, and typical wrong ones fail."""

from lessons.exercise_cells import undetected
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l01 import exercises, spec

MISTAKES = {
    "    scene.reset()\n": [""],
    "scene.step()": ["pass"],
    "range(steps)": ["range(steps + 1)"],
}


def test_each_mistake_is_found():
    sphere = FakeBody(1.0, spec.BASELINE.height)
    scene = FakeScene(sphere, dt=spec.BASELINE.dt, substeps=spec.BASELINE.substeps)
    given = exercises.fall, MISTAKES, "l01", "fall", scene, sphere
    assert undetected(*given) == []
