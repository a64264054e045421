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


CASES = {
    "height_after": {
        "right": SOLVED["height_after"],
        "school": lambda z0, g, h, n: height(z0, g, h, n, school=True),
        "explicit Euler": lambda z0, g, h, n: height(z0, g, h, n, extra=-1),
        "typed values": lambda z0, g, h, n: height(0.5, 9.81, h, n),
        "distance for height": lambda z0, g, h, n: height(0, g, h, n),
    },
    "fall": {
        "right": SOLVED["fall"],
        "no reset": partial(fall, reset=False),
        "read too early": partial(fall, late=False),
        "one step more": lambda scene, sphere, steps: fall(scene, sphere, steps + 1),
        "typed result": lambda scene, sphere, steps: 0.298895,
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in CASES.items() for how in of])
def test_only_the_right_solution_passes(name, how):
    sphere = FallingSphere()
    more = {"fall": (sphere, sphere)}.get(name, ())
    (check,) = getattr(exercises, name)(CASES[name][how], *more)
    assert check.passed == (how == "right"), check.detail
