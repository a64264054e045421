"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

from types import SimpleNamespace

import numpy as np
import pytest
import torch
from lessons.body_runs import make_drop
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l02 import exercises, spec
from robo_genesis.sim.bodies.free_fall import continuous_drop

SOLVED = solutions("l02")
OURS, FRAME, STEPPED = SOLVED["record"], SOLVED["usable_frame"], SOLVED["stepped"]


class FallingBox:
    """A scene and its box, which falls by semi-implicit Euler until it lies on a ground."""

    def __init__(self, substeps=2, dt=0.01, rho=500, size=0.1, height=0.5, ground=True,
                 fixed=False, is_built=True):  # fmt: skip
        self.dt, self.substeps, self.is_built, self.fixed = dt, substeps, is_built, fixed
        self.mass, self.height = rho * size**3, height
        self.lowest = size / 2 if ground else -np.inf
        self.reset()

    def reset(self):
        self.z, self.v = self.height, 0.0

    def step(self):
        h = self.dt / self.substeps
        for _ in range(0 if self.fixed else self.substeps):
            self.v -= 9.81 * h
            self.z += self.v * h
            if self.z < self.lowest:
                self.z, self.v = self.lowest, 0.0

    def get_mass(self):
        return self.mass

    def get_pos(self):
        return torch.tensor([0.0, 0.0, self.z], dtype=torch.float64)

    def get_vel(self):
        return torch.tensor([0.0, 0.0, self.v], dtype=torch.float64)


def scene_with(**mistake):
    def make(gs):
        box = FallingBox(**mistake)
        return box, box

    return make


def without_reset(scene, box, steps):
    return OURS(SimpleNamespace(step=scene.step, reset=lambda: None), box, steps)


CASES = {
    "scene": {
        "right": scene_with(),
        "one substep": scene_with(substeps=1),
        "another dt": scene_with(dt=0.02),
        "the default density": scene_with(rho=600),
        "the underside at half a metre": scene_with(height=0.55),
        "no ground": scene_with(ground=False),
        "fixed": scene_with(fixed=True),
        "not built": scene_with(is_built=False),
    },
    "record": {
        "right": OURS,
        "without the first state": lambda *of: [values[1:] for values in OURS(*of)],
        "without a reset": without_reset,
        "read once": lambda *of: [[values[0]] * len(values) for values in OURS(*of)],
        "speed downwards": lambda *of: (OURS(*of)[0], [-speed for speed in OURS(*of)[1]]),
        "heights alone": lambda *of: OURS(*of)[:1],
    },
    "usable_frame": {
        "right": FRAME,
        "always": lambda rgb: True,
        "extremes": lambda rgb: FRAME(rgb) and rgb[..., 0].max() > 30,
        "any dtype": lambda rgb: rgb.shape == (540, 720, 3) and bool((rgb != rgb[0, 0]).any()),
        "any shape": lambda rgb: bool((rgb != rgb[0, 0]).any()) and rgb.dtype == np.uint8,
    },
    "stepped": {
        "right": STEPPED,
        "explicit Euler": lambda g, h, n: g * h**2 * np.arange(n + 1) * np.arange(-1, n) / 2,
        "the school formula": lambda g, h, n: continuous_drop(h * np.arange(n + 1), g),
        "without the start": lambda g, h, n: STEPPED(g, h, n)[1:],
        "another gravity": lambda g, h, n: STEPPED(9.81, h, n),
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in CASES.items() for how in of])
def test_only_the_right_solution_passes(name, how):
    box = FallingBox()
    box.step()  # the student's record starts from any state
    more = {"scene": (None, spec.BASELINE), "record": (box, box, make_drop(spec.BASELINE))}
    (check,) = getattr(exercises, name)(CASES[name][how], *more.get(name, ()))
    assert check.passed == (how == "right"), check.detail
