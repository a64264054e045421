"""The tests of the student's functions: our solutions pass, and typical wrong ones fail."""

from functools import partial

import pytest
from lessons.exercise_cells import solutions
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l01 import exercises, spec

SOLVED = solutions("l01")


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
        "not below zero": lambda *given: max(height(*given), 0),
    },
    "fall": {
        "right": SOLVED["fall"],
        "no reset": partial(fall, reset=False),
        "read too early": partial(fall, late=False),
        "one step more": lambda scene, sphere, steps: fall(scene, sphere, steps + 1),
    },
}


@pytest.mark.parametrize(
    ("name", "how"), [(n, how) for n, of in CASES.items() for how in of]
)
def test_only_the_right_solution_passes(name, how):
    sphere = FakeBody(1.0, spec.BASELINE.height)
    scene = FakeScene(sphere, dt=spec.BASELINE.dt, substeps=spec.BASELINE.substeps)
    more = {"fall": (scene, sphere)}.get(name, ())
    check = getattr(exercises, name)(CASES[name][how], *more)
    assert check.passed == (how == "right"), check.detail
