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


def chain_of(joints):
    """Return a chain in which some joints turn alone."""

    def chain(q, links):
        at, quat = np.zeros(3), np.array([1.0, 0, 0, 0])
        for k, (_, offset, orientation) in enumerate(links):
            at = at + of.rotate(quat, np.array(offset))
            quat = of.quat_multiply(quat, np.array(orientation))
            if k in joints:
                quat = of.quat_multiply(quat, of.about_z(q[k]))
        return at, quat

    return chain


def with_quat(change):
    """Return the right chain with a change of its quaternion."""
    return lambda q, links: (CHAIN(q, links)[0], change(CHAIN(q, links)[1]))


def fed(function, change):
    """Return a solution that gets changed arguments."""
    return lambda *given: function(*change(*given))


def in_place(function, number):
    """Return a solution that changes the argument of a number."""

    def changing(*given):
        found = function(*given)
        given[number][...] = 0
        return found

    return changing


def left_out(where):
    """Return a projection without the points that a function of depth and pixel chooses."""

    def project(points, K, transform):
        depth, at = (
            cameras.in_camera(points, transform)[:, 2:],
            PROJECT(points, K, transform),
        )
        return np.where(where(depth, at), np.nan, at)

    return project


def behind_kept(points, K, transform):
    seen = cameras.in_camera(points, transform)
    return (seen / seen[:, 2:] @ K.T)[:, :2]


def fx_alone(K):
    return np.vstack([K[0], [0, K[0, 0], K[1, 2]], K[2]])


CASES = {  # wrong solutions that only few of a test's findings tell from a right one
    "forward": {
        "right": CHAIN,
        "right, negative quaternion": with_quat(np.negative),
        "right, changed nothing": chain_of(range(7)),
        "the fifth joint left out": chain_of((0, 1, 2, 3, 5, 6)),
        "the last joint left out": chain_of(range(6)),
        "conjugate": with_quat(lambda quat: quat * [1, -1, -1, -1]),
        "not of unit length": with_quat(lambda quat: 2 * quat),
        "rounded": lambda q, links: (CHAIN(q, links)[0].round(4), CHAIN(q, links)[1]),
        "a matrix": with_quat(lambda quat: np.eye(3)),
        "always the whole chain": lambda q, n: CHAIN(q, of.CHAIN),
    },
    "step": {
        "right": STEP,
        "right, JᵀJ": lambda J, e, d: np.linalg.solve(
            J.T @ J + d**2 * np.eye(len(J.T)), J.T @ e
        ),
        "typed damping": lambda J, e, d: STEP(J, e, 0.01),
        "bounded": lambda J, e, d: np.clip(STEP(J, e, d), -0.05, 0.05),
        "as a column": lambda J, e, d: STEP(J, e, d)[:, None],
        "six rows alone": lambda J, e, d: (
            J.T @ np.linalg.solve(J @ J.T + d**2 * np.eye(6), e)
        ),
        "seven joints alone": lambda J, e, d: np.linalg.solve(
            J.T @ J + d**2 * np.eye(7), J.T @ e
        ),
        "damping for six rows alone": lambda J, e, d: STEP(
            J, e, d if len(e) == 6 else 0.01
        ),
        "error changed": in_place(STEP, 1),
    },
    "acceptance": {
        "right": ACCEPT,
        "signed": fed(ACCEPT, lambda q, e, *rest: (q, np.maximum(e, 0), *rest)),
        "rotation alone": fed(
            ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, np.inf, b, c)
        ),
        "arm alone": fed(ACCEPT, lambda q, *rest: (q[:7], *rest)),
        "typed tolerances": fed(
            ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, 5e-4, 5e-3, c)
        ),
        "typed clearance": fed(
            ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, a, b, 0.03)
        ),
        "clearance above zero": fed(ACCEPT, lambda *given: (*given[:5], 0)),
        "size of the clearance": fed(
            ACCEPT, lambda q, e, tip, *rest: (q, e, abs(tip), *rest)
        ),
        "below the tolerances": fed(
            ACCEPT, lambda *g: (*g[:3], 0.99 * g[3], 0.99 * g[4], g[5])
        ),
        "rotation about z left out": fed(
            ACCEPT, lambda q, e, *r: (q, e * (1, 1, 1, 1, 1, 0), *r)
        ),
        "ends of q alone": fed(ACCEPT, lambda q, *rest: (q[[0, -1]], *rest)),
        "turn not a number": fed(
            ACCEPT, lambda q, e, *r: (q, [*e[:3], *np.nan_to_num(e[3:])], *r)
        ),
    },
    "project": {
        "right": PROJECT,
        "centre of pixels at whole numbers": lambda *given: PROJECT(*given) - 0.5,
        "pose transposed": lambda p, k, t: PROJECT(p, k, t.T),
        "fx for fy": lambda p, k, t: PROJECT(p, fx_alone(k), t),
        "middle typed": lambda p, k, t: PROJECT(p, np.c_[k[:, :2], (16, 10, 1)], t),
        "points behind kept": behind_kept,
        "one point alone": lambda p, k, t: PROJECT(p[:1], k, t)[0],
        "beside the picture": left_out(
            lambda depth, at: at.min(axis=1, keepdims=True) < 0
        ),
        "far points left out": left_out(lambda depth, at: depth > 20),
        "near points left out": left_out(lambda depth, at: depth < 0.1),
        "others change": lambda p, k, t: (
            PROJECT(p, k, t) + np.isnan(PROJECT(p, k, t)).any()
        ),
    },
    "back_project": {
        "right": BACK,
        "half a pixel missing": lambda d, k, t: BACK(
            d, k + np.outer([0.5, 0.5, 0], [0, 0, 1]), t
        ),
        "camera coordinates": lambda d, k, t: BACK(d, k, cameras.FLIP),
        "fx for fy": lambda d, k, t: BACK(d, fx_alone(k), t),
        "one depth for all": lambda d, k, t: BACK(np.full_like(d, d.mean()), k, t),
        "size typed": lambda d, k, t: BACK(np.resize(d, (20, 32)), k, t),
    },
}


@pytest.mark.parametrize(
    ("name", "how"), [(n, how) for n, of in CASES.items() for how in of]
)
def test_only_right_solutions_pass(reaches, name, how):
    more = {"forward": (reaches.traces["baseline"],)}.get(name, ())
    check = getattr(exercises, name)(CASES[name][how], *more)
    assert check.passed == how.startswith("right"), check.detail
