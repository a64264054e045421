"""The tests of the student's camera functions: ours pass, and typical wrong ones fail."""

import numpy as np
import pytest

from robo_genesis.lessons.l05 import camera_exercises as exercises
from robo_genesis.sim import camera_geometry as cameras

FLIP = cameras.FLIP


def lifted(depth, K, transform, half=0.5, flip=FLIP, along=False, swap=False):
    """Return back-projected pixels, with one mistake."""
    v, u = np.indices(depth.shape) + half
    u, v = (v, u) if swap else (u, v)
    unit = np.dstack([u, v, np.ones(depth.shape)]) @ np.linalg.inv(K).T
    if along:
        unit /= np.linalg.norm(unit, axis=-1, keepdims=True)
    pose = transform @ flip
    return (unit * depth[..., None]) @ pose[:3, :3].T + pose[:3, 3]


def flattened(points, K, transform, flip=FLIP):
    """Return projected points, with the given turn of the axes."""
    pose = transform @ flip
    seen = (points - pose[:3, 3]) @ pose[:3, :3]
    return (seen / seen[:, 2:] @ K.T)[:, :2]


def raises(*_):
    raise NotImplementedError("write it")


RIGHT = {
    "project": (cameras.project, flattened),
    "back_project": (cameras.back_project, lifted),
}
WRONG = {
    "project": {
        "u and v swapped": lambda *given: flattened(*given)[:, ::-1],
        "OpenGL axes": lambda *given: flattened(*given, flip=np.eye(4)),
        "centre of pixels at whole numbers": lambda *given: flattened(*given) - 0.5,
        "not divided by the depth": lambda p, k, t: (cameras.in_camera(p, t) @ k.T)[:, :2],
        "from camera to world": lambda p, k, t: flattened(p, k, np.linalg.inv(t)),
        "one point alone": lambda p, k, t: flattened(p[:1], k, t)[0],
        "not written": raises,
    },
    "back_project": {
        "u and v swapped": lambda *given: lifted(*given, swap=True),
        "rows and columns swapped": lambda *given: np.swapaxes(lifted(*given), 0, 1),
        "OpenGL axes": lambda *given: lifted(*given, flip=np.eye(4)),
        "depth along the ray": lambda *given: lifted(*given, along=True),
        "half a pixel missing": lambda *given: lifted(*given, half=0.0),
        "camera coordinates": lambda d, k, t: lifted(d, k, FLIP),
        "not written": raises,
    },
}


@pytest.mark.parametrize(("name", "which"), [(n, k) for n, of in RIGHT.items() for k in (0, 1)])
def test_a_right_solution_passes(name, which):
    (check,) = getattr(exercises, name)(RIGHT[name][which])
    assert check.passed, check.detail


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in WRONG.items() for how in of])
def test_a_wrong_solution_fails_and_is_told_what_was_found(name, how):
    (check,) = getattr(exercises, name)(WRONG[name][how])
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail
