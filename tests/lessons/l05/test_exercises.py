"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

import numpy as np
import pytest
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l05 import exercises
from robo_genesis.sim.arm import kinematics as of
from robo_genesis.sim.camera import geometry as cameras

SOLVED = solutions("l05")
CHAIN, STEP, ACCEPT = SOLVED["chain"], SOLVED["damped"], SOLVED["accept"]
PROJECT, BACK = SOLVED["project"], SOLVED["back_project"]


def turned_before_offset(q, links):
    """Turn each joint before its link's fixed transform."""
    position, quat = np.zeros(3), np.array([1.0, 0, 0, 0])
    for k, (_, offset, orientation) in enumerate(links):
        if k < 7:
            quat = of.quat_multiply(quat, of.about_z(q[k]))
        position = position + of.rotate(quat, np.array(offset))
        quat = of.quat_multiply(quat, np.array(orientation))
    return position, quat


def with_quat(change):
    """Return the right chain with a change of its quaternion."""

    def chain(q, links):
        position, quat = CHAIN(q, links)
        return position, change(quat)

    return chain


def along_the_ray(depth, K, transform):
    rays = BACK(np.ones_like(depth), K, np.eye(4))
    return BACK(depth / np.linalg.norm(rays, axis=-1), K, transform)


def moved_centre(K, by):
    moved = K.copy()
    moved[:2, 2] += by
    return moved


CASES = {
    "forward": {
        "right": CHAIN,
        "right, negative quaternion": with_quat(np.negative),
        "degrees": lambda q, n: CHAIN(np.deg2rad(q), n),
        "joint before offset": turned_before_offset,
        "the fifth joint left out": lambda q, n: CHAIN(q * (np.arange(7) != 4), n),
        "xyzw": with_quat(lambda quat: np.roll(quat, -1)),
        "always the whole chain": lambda q, n: CHAIN(q, of.CHAIN),
        "nothing returned": lambda q, n: None,
    },
    "step": {
        "right": STEP,
        "right, other side": lambda J, e, d: np.linalg.solve(
            J.T @ J + d**2 * np.eye(J.shape[1]), J.T @ e
        ),
        "no damping": lambda J, e, d: np.linalg.pinv(J) @ e,
        "damping not squared": lambda J, e, d: STEP(J, e, np.sqrt(d)),
        "away from the target": lambda J, e, d: -STEP(J, e, d),
        "six rows alone": lambda J, e, d: J.T @ np.linalg.solve(J @ J.T + d**2 * np.eye(6), e),
    },
    "acceptance": {
        "right": ACCEPT,
        "always": lambda q, e, most, angle: True,
        "signed": lambda q, e, most, angle: ACCEPT(q, np.maximum(e, 0), most, angle),
        "each entry": lambda q, e, most, angle: bool(
            (abs(e[:3]) <= most).all() and (abs(e[3:]) <= angle).all()
        ),
        "position alone": lambda q, e, most, angle: ACCEPT(q, e, most, np.inf),
        "q not looked at": lambda q, e, most, angle: ACCEPT(np.zeros(9), e, most, angle),
        "one norm of six": lambda q, e, most, angle: bool(np.linalg.norm(e) <= most),
        "typed tolerances": lambda q, e, most, angle: ACCEPT(q, e, 5e-4, 5e-3),
    },
    "project": {
        "right": PROJECT,
        "u and v swapped": lambda *given: PROJECT(*given)[:, ::-1],
        "OpenGL axes": lambda p, k, t: PROJECT(p, k, t @ cameras.FLIP),
        "centre of pixels at whole numbers": lambda *given: PROJECT(*given) - 0.5,
        "not divided by the depth": lambda p, k, t: (cameras.in_camera(p, t) @ k.T)[:, :2],
        "from camera to world": lambda p, k, t: PROJECT(p, k, np.linalg.inv(t)),
        "one point alone": lambda p, k, t: PROJECT(p[:1], k, t)[0],
    },
    "back_project": {
        "right": BACK,
        "u and v swapped": lambda d, k, t: np.swapaxes(BACK(d.T, k, t), 0, 1),
        "rows and columns swapped": lambda *given: np.swapaxes(BACK(*given), 0, 1),
        "OpenGL axes": lambda d, k, t: BACK(d, k, t @ cameras.FLIP),
        "depth along the ray": along_the_ray,
        "half a pixel missing": lambda d, k, t: BACK(d, moved_centre(k, 0.5), t),
        "camera coordinates": lambda d, k, t: BACK(d, k, cameras.FLIP),
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in CASES.items() for how in of])
def test_only_right_solutions_pass(reaches, name, how):
    more = {"forward": (reaches.traces["baseline"],)}.get(name, ())
    check = getattr(exercises, name)(CASES[name][how], *more)
    assert check.passed == how.startswith("right"), check.detail
