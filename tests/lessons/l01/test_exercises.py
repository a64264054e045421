"""The tests of the student's functions: our solutions pass, and typical wrong ones fail."""

from functools import partial

import pytest
import torch
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l01 import exercises, spec

SOLVED = solutions("l01")


class FallingSphere:
    """A sphere, and a scene that steps it by semi-implicit Euler."""

    def __init__(self):
        self.reset()

    def reset(self):
        self.z, self.v = spec.BASELINE.height, 0.0

    def step(self):
        for _ in range(spec.BASELINE.substeps):
            self.v -= 9.81 * spec.BASELINE.h
            self.z += self.v * spec.BASELINE.h

    def get_pos(self):
        return torch.tensor([0.0, 0.0, self.z], dtype=torch.float64)


def height(z0, g, h, n, *, extra=1, school=False):
    return z0 - (g * (h * n) ** 2 / 2 if school else g * h**2 * n * (n + extra) / 2)


def fall(scene, sphere, steps, *, reset=True, late=True):
    """Return the last height; other values of the last arguments make mistakes."""
    if reset:
        scene.reset()
    kept = sphere.get_pos()[2].item()
    for _ in range(steps):
        scene.step()
    return sphere.get_pos()[2].item() if late else kept


@pytest.mark.parametrize(
    ("function", "passes"),
    [
        (SOLVED["height_after"], True),
        (lambda z0, g, h, n: height(z0, g, h, n, school=True), False),
        (lambda z0, g, h, n: height(z0, g, h, n, extra=-1), False),
        (lambda z0, g, h, n: height(0.5, 9.81, h, n), False),
        (lambda z0, g, h, n: height(0, g, h, n), False),
    ],
)
def test_the_height_is_that_of_the_stepped_fall(function, passes):
    assert [check.passed for check in exercises.height_after(function)] == [passes]


@pytest.mark.parametrize(
    ("function", "passes"),
    [
        (SOLVED["fall"], True),
        (partial(fall, reset=False), False),
        (partial(fall, late=False), False),
        (lambda scene, sphere, steps: fall(scene, sphere, steps + 1), False),
        (lambda scene, sphere, steps: 0.298895, False),
    ],
)
def test_the_fall_starts_anew_each_time(function, passes):
    sphere = FallingSphere()
    assert [check.passed for check in exercises.fall(function, sphere, sphere)] == [passes]
