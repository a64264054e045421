"""The tests of the student's functions: our solutions pass, and typical wrong ones fail."""

from types import SimpleNamespace

import numpy as np
import pytest
import torch
from lessons.body_runs import make_drop
from lessons.exercise_cells import require_exercise, solutions

from robo_genesis.core.free_fall import continuous_drop
from robo_genesis.lessons.l02 import exercises, spec

SOLVED = solutions("l02")
CASE = spec.BASELINE


class FakeBody:
    """A box that falls by semi-implicit Euler until it lies on a ground, if there is one."""

    def __init__(self, morph, material):
        self.morph, self.material = morph, material
        self.reset()

    def reset(self):
        self.z, self.v = float(self.morph.pos[2]), 0.0

    def get_mass(self):
        return self.material.rho * float(np.prod(self.morph.size))

    def get_pos(self):
        return torch.tensor([*self.morph.pos[:2], self.z], dtype=torch.float64)

    def get_vel(self):
        return torch.tensor([0.0, 0.0, self.v], dtype=torch.float64)


class FakeScene:
    """A scene whose bodies fall."""

    def __init__(self, sim_options, **_):
        self.dt, self.substeps = sim_options.dt, sim_options.substeps
        self.is_built, self.ground, self.bodies = False, False, []

    def add_entity(self, morph, material=None, **_):
        if morph is PLANE:
            self.ground = True
            return None
        self.bodies.append(FakeBody(morph, material or rigid()))
        return self.bodies[-1]

    def build(self):
        self.is_built = True

    def reset(self):
        for body in self.bodies:
            body.reset()

    def step(self):
        h = self.dt / self.substeps
        for body in self.bodies:
            for _ in range(0 if body.morph.fixed else self.substeps):
                body.v -= 9.81 * h
                body.z += body.v * h
                lowest = body.morph.size[2] / 2
                if self.ground and body.z < lowest:
                    body.z, body.v = lowest, 0.0


PLANE = object()


def rigid(rho=600.0):
    return SimpleNamespace(rho=rho)


GS = SimpleNamespace(
    Scene=FakeScene,
    options=SimpleNamespace(
        SimOptions=lambda dt=0.01, substeps=1: SimpleNamespace(dt=dt, substeps=substeps),
        ProfilingOptions=lambda **_: None,
    ),
    morphs=SimpleNamespace(
        Plane=lambda: PLANE,
        Box=lambda size, pos, fixed=False: SimpleNamespace(size=size, pos=pos, fixed=fixed),
    ),
    materials=SimpleNamespace(Rigid=rigid),
)


def scene_with(substeps=2, dt=0.01, rho=500, size=0.1, height=0.5, ground=True, fixed=False,
               build=True):  # fmt: skip
    """Return a function that makes the scene with one mistake."""

    def make(gs):
        scene = gs.Scene(gs.options.SimOptions(dt=dt, substeps=substeps))
        if ground:
            scene.add_entity(gs.morphs.Plane())
        morph = gs.morphs.Box(size=(size,) * 3, pos=(0, 0, height), fixed=fixed)
        box = scene.add_entity(morph, material=gs.materials.Rigid(rho=rho))
        if build:
            scene.build()
        return scene, box

    return make


def without_start(scene, box, steps):
    heights, speeds = SOLVED["record"](scene, box, steps)
    return heights[1:], speeds[1:]


def without_reset(scene, box, steps):
    heights, speeds = [box.get_pos()[2].item()], [box.get_vel()[2].item()]
    for _ in range(steps):
        scene.step()
        heights.append(box.get_pos()[2].item())
        speeds.append(box.get_vel()[2].item())
    return heights, speeds


def read_once(scene, box, steps):
    scene.reset()
    z, v = box.get_pos()[2].item(), box.get_vel()[2].item()
    for _ in range(steps):
        scene.step()
    return [z] * (steps + 1), [v] * (steps + 1)


def downwards(scene, box, steps):
    heights, speeds = SOLVED["record"](scene, box, steps)
    return heights, [-speed for speed in speeds]


def explicit(g, h, n):
    v, z, fallen = 0.0, 0.0, [0.0]
    for _ in range(n):
        z = z + v * h
        v = v + g * h
        fallen.append(z)
    return fallen


WRONG = {
    "scene": {
        "one substep": scene_with(substeps=1),
        "another dt": scene_with(dt=0.02),
        "the default density": scene_with(rho=600),
        "a larger box": scene_with(size=0.2, rho=62.5),
        "the underside at half a metre": scene_with(height=0.55),
        "no ground": scene_with(ground=False),
        "fixed": scene_with(fixed=True),
        "not built": scene_with(build=False),
        "not written": lambda gs: (_ for _ in ()).throw(NotImplementedError("write it")),
    },
    "record": {
        "without the first state": without_start,
        "without a reset": without_reset,
        "read once": read_once,
        "speed downwards": downwards,
        "one step more": lambda scene, box, steps: SOLVED["record"](scene, box, steps + 1),
        "heights alone": lambda scene, box, steps: SOLVED["record"](scene, box, steps)[:1],
    },
    "usable_frame": {
        "always": lambda rgb: True,
        "smallest and largest value": lambda rgb: (
            rgb.shape == (540, 720, 3) and rgb.dtype == np.uint8 and rgb.min() != rgb.max()
        ),
        "any dtype": lambda rgb: rgb.shape == (540, 720, 3) and bool((rgb != rgb[0, 0]).any()),
        "any shape": lambda rgb: rgb.dtype == np.uint8 and bool((rgb != rgb[0, 0]).any()),
        "most pixels": lambda rgb: SOLVED["usable_frame"](rgb)
        and float((rgb != rgb[0, 0]).mean()) > 0.01,
    },
    "stepped": {
        "explicit Euler": explicit,
        "the school formula": lambda g, h, n: continuous_drop(h * np.arange(n + 1), g),
        "the last distance alone": lambda g, h, n: SOLVED["stepped"](g, h, n)[-1],
        "without the start": lambda g, h, n: SOLVED["stepped"](g, h, n)[1:],
        "another gravity": lambda g, h, n: SOLVED["stepped"](9.81, h, n),
    },
}  # fmt: skip
OURS = {"scene": "make_scene", "record": "record", "usable_frame": "usable_frame",
        "stepped": "stepped"}  # fmt: skip


def outcome_of(name, function):
    """Return the outcome of one exercise for a function."""
    scene, box = SOLVED["make_scene"](GS)
    scene.step()  # the student's record starts from any state
    more = {"scene": (GS, CASE), "record": (scene, box, make_drop(CASE))}.get(name, ())
    (check,) = getattr(exercises, name)(function, *more)
    return check


@pytest.mark.parametrize("name", OURS)
def test_our_solution_passes(name):
    check = outcome_of(name, SOLVED[OURS[name]])
    assert check.passed, check.detail


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in WRONG.items() for how in of])
def test_a_wrong_solution_fails_and_its_check_says_what_was_found(name, how):
    check = outcome_of(name, WRONG[name][how])
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail


def test_each_function_has_at_least_three_wrong_solutions():
    assert all(len(found) >= 3 for found in WRONG.values())
    assert WRONG.keys() == OURS.keys()


@pytest.mark.parametrize("name", OURS.values())
def test_the_student_writes_at_most_fifteen_lines_below_a_docstring(name):
    require_exercise("l02", name)
