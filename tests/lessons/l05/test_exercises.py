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


def chain_of(
    place=of.rotate, multiply=of.quat_multiply, about=of.about_z, joints=range(7), first=False
):
    """Return a chain with one part changed; with `first` a joint turns before its link's offset."""

    def chain(q, links):
        at, quat = np.zeros(3), np.array([1.0, 0, 0, 0])
        for k, (_, offset, orientation) in enumerate(links):
            turn = about(q[k]) if k in joints else np.array([1.0, 0, 0, 0])
            if first:
                quat = multiply(quat, turn)
            at, quat = at + place(quat, np.array(offset)), multiply(quat, np.array(orientation))
            if not first:
                quat = multiply(quat, turn)
        return at, quat

    return chain


def with_quat(change):
    """Return the right chain with a change of its quaternion."""
    return lambda *given: (CHAIN(*given)[0], change(CHAIN(*given)[1]))


def with_place(change):
    """Return the right chain with a change of its position."""
    return lambda *given: (change(CHAIN(*given)[0]), CHAIN(*given)[1])


def damped(left):
    """Return a step whose matrix is a function of J Jᵀ and the damping."""
    return lambda J, e, d: J.T @ np.linalg.solve(left(J @ J.T, d), e)


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


def along_the_ray(depth, K, transform):
    rays = BACK(np.ones_like(depth), K, np.eye(4))
    return BACK(depth / np.linalg.norm(rays, axis=-1), K, transform)


def changed(K, by=0.0, focal=slice(0)):
    """Return K with its principal point moved, and one focal length for both."""
    K = K.copy()
    K[:2, 2] += by
    K[[0, 1], [0, 1]] = K[focal, focal].diagonal().max() if focal != slice(0) else K.diagonal()[:2]
    return K


def within(values, low, high):
    """Return values with NaN in the place of those that are too low or too high."""
    return np.where((values >= low) & (values <= high), values, np.nan)


def by(divisor):
    """Return a projection that divides points of the camera by a function of them."""
    return lambda p, k, t: ((s := cameras.in_camera(p, t)) @ k.T / divisor(s))[:, :2]


CASES = {
    "forward": {
        "right": CHAIN,
        "right, negative quaternion": with_quat(np.negative),
        "right, changed nothing": chain_of(),
        "degrees": lambda q, n: CHAIN(np.deg2rad(q), n),
        "joint before offset": chain_of(first=True),
        "the fifth joint left out": chain_of(joints=(0, 1, 2, 3, 5, 6)),
        "the last joint left out": chain_of(joints=range(6)),
        "the first joint left out": chain_of(joints=range(1, 7)),
        "a joint for the hand": chain_of(joints=range(8)),
        "offset not turned": chain_of(place=lambda quat, offset: offset),
        "factors exchanged": chain_of(multiply=lambda a, b: of.quat_multiply(b, a)),
        "turned backwards": chain_of(about=lambda angle: of.about_z(-angle)),
        "half angle not halved": chain_of(about=lambda angle: of.about_z(2 * angle)),
        "about x": chain_of(about=lambda angle: of.about_z(angle)[[0, 3, 1, 2]]),
        "links not turned": lambda q, n: CHAIN(q, [(*of[:2], (1, 0, 0, 0)) for of in n]),
        "xyzw": with_quat(lambda quat: np.roll(quat, -1)),
        "conjugate": with_quat(lambda quat: quat * [1, -1, -1, -1]),
        "not of unit length": with_quat(lambda quat: 2 * quat),
        "millimetres": with_place(lambda at: 1000 * at),
        "rounded": with_place(lambda at: at.round(4)),
        "a matrix": with_quat(lambda quat: np.eye(3)),
        "always the whole chain": lambda q, n: CHAIN(q, of.CHAIN),
        "angles changed": in_place(CHAIN, 0),
        "nothing returned": lambda q, n: None,
    },
    "step": {
        "right": STEP,
        "right, other side": lambda J, e, d: np.linalg.solve(
            J.T @ J + d**2 * np.eye(J.shape[1]), J.T @ e
        ),
        "no damping": lambda J, e, d: np.linalg.pinv(J) @ e,
        "damping not squared": damped(lambda left, d: left + d * np.eye(len(left))),
        "damping doubled": damped(lambda left, d: left + 2 * d**2 * np.eye(len(left))),
        "damping of each entry": damped(lambda left, d: left + d**2),
        "damping subtracted": damped(lambda left, d: left - d**2 * np.eye(len(left))),
        "typed damping": damped(lambda left, d: left + 1e-4 * np.eye(len(left))),
        "relative damping": damped(lambda left, d: left + d**2 * np.diag(left.diagonal())),
        "away from the target": lambda J, e, d: -STEP(J, e, d),
        "gradient": lambda J, e, d: J.T @ e,
        "bounded": lambda J, e, d: np.clip(STEP(J, e, d), -0.05, 0.05),
        "half of it": lambda J, e, d: STEP(J, e, d) / 2,
        "of length 1": lambda J, e, d: STEP(J, e, d) / np.linalg.norm(STEP(J, e, d)),
        "as a column": lambda J, e, d: STEP(J, e, d)[:, None],
        "six rows alone": lambda J, e, d: J.T @ np.linalg.solve(J @ J.T + d**2 * np.eye(6), e),
        "seven joints alone": lambda J, e, d: np.linalg.solve(J.T @ J + d**2 * np.eye(7), J.T @ e),
        "damping for six rows alone": lambda J, e, d: STEP(J, e, d if len(e) == 6 else 0.01),
        "error changed": in_place(STEP, 1),
    },
    "acceptance": {
        "right": ACCEPT,
        "always": lambda *given: True,
        "signed": fed(ACCEPT, lambda q, e, *rest: (q, np.maximum(e, 0), *rest)),
        "each entry": lambda q, e, tip, a, b, least: bool(
            (abs(e[:3]) <= a).all() and (abs(e[3:]) <= b).all() and tip >= least
        ),
        "position alone": fed(ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, a, np.inf, c)),
        "rotation alone": fed(ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, np.inf, b, c)),
        "q not looked at": fed(ACCEPT, lambda q, *rest: (np.zeros(9), *rest)),
        "arm alone": fed(ACCEPT, lambda q, *rest: (q[:7], *rest)),
        "one norm of six": lambda q, e, tip, a, b, c: bool(np.linalg.norm(e) <= a),
        "tolerances exchanged": fed(ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, b, a, c)),
        "typed tolerances": fed(ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, 5e-4, 5e-3, c)),
        "typed clearance": fed(ACCEPT, lambda q, e, tip, a, b, c: (q, e, tip, a, b, 0.03)),
        "clearance not looked at": fed(ACCEPT, lambda q, e, tip, *rest: (q, e, 1.0, *rest)),
        "clearance above zero": fed(ACCEPT, lambda *given: (*given[:5], 0)),
        "above the least clearance": lambda *given: ACCEPT(*given) and given[2] > given[5],
        "size of the clearance": fed(ACCEPT, lambda q, e, tip, *rest: (q, e, abs(tip), *rest)),
        "below the tolerances": fed(ACCEPT, lambda *g: (*g[:3], 0.99 * g[3], 0.99 * g[4], g[5])),
        "rotation about z left out": fed(ACCEPT, lambda q, e, *r: (q, e * (1, 1, 1, 1, 1, 0), *r)),
        "ends of q alone": fed(ACCEPT, lambda q, *rest: (q[[0, -1]], *rest)),
        "not too large": fed(ACCEPT, lambda q, e, *r: (q, np.r_[e[:3], np.nan_to_num(e[3:])], *r)),
        "no answer": lambda *given: None,
    },
    "project": {
        "right": PROJECT,
        "u and v swapped": lambda *given: PROJECT(*given)[:, ::-1],
        "OpenGL axes": lambda p, k, t: PROJECT(p, k, t @ cameras.FLIP),
        "centre of pixels at whole numbers": lambda *given: PROJECT(*given) - 0.5,
        "not divided by the depth": by(lambda seen: 1),
        "divided by the distance": by(lambda seen: np.linalg.norm(seen, axis=1)[:, None]),
        "from camera to world": lambda p, k, t: PROJECT(p, k, np.linalg.inv(t)),
        "pose transposed": lambda p, k, t: PROJECT(p, k, t.T),
        "place of the camera left out": lambda p, k, t: PROJECT(p + t[:3, 3], k, t),
        "K transposed": lambda p, k, t: PROJECT(p, k.T, t),
        "fx for fy": lambda p, k, t: PROJECT(p, changed(k, focal=slice(0, 1)), t),
        "fy for fx": lambda p, k, t: PROJECT(p, changed(k, focal=slice(1, 2)), t),
        "v upwards": lambda p, k, t: PROJECT(p, k, t) * [1, -1] + [0, 2 * k[1, 2]],
        "middle of the picture left out": lambda p, k, t: PROJECT(p, k, t) - k[:2, 2],
        "whole pixels": lambda *given: PROJECT(*given).round(),
        "points behind kept": by(lambda seen: seen[:, 2:]),
        "points behind in front": by(lambda seen: abs(seen[:, 2:])),
        "all or none": lambda p, k, t: PROJECT(p, k, t) + 0 * PROJECT(p, k, t).sum(),
        "middle typed": lambda p, k, t: PROJECT(p, changed(k, by=(16, 10) - k[:2, 2]), t),
        "one point alone": lambda p, k, t: PROJECT(p[:1], k, t)[0],
        "beside the picture": lambda *given: within(PROJECT(*given), 0, np.inf),
        "far points left out": by(lambda seen: within(seen[:, 2:], 0, 20)),
        "near points left out": by(lambda seen: within(seen[:, 2:], 0.1, np.inf)),
        "others change": lambda p, k, t: PROJECT(p, k, t) + np.isnan(PROJECT(p, k, t)).any(),
        "points changed": in_place(PROJECT, 0),
        "pose changed": in_place(PROJECT, 2),
    },
    "back_project": {
        "right": BACK,
        "u and v swapped": lambda d, k, t: np.swapaxes(BACK(d.T, k, t), 0, 1),
        "rows and columns swapped": lambda *given: np.swapaxes(BACK(*given), 0, 1),
        "OpenGL axes": lambda d, k, t: BACK(d, k, t @ cameras.FLIP),
        "depth along the ray": along_the_ray,
        "half a pixel missing": lambda d, k, t: BACK(d, changed(k, by=0.5), t),
        "half a pixel too much": lambda d, k, t: BACK(d, changed(k, by=-0.5), t),
        "camera coordinates": lambda d, k, t: BACK(d, k, cameras.FLIP),
        "fx for fy": lambda d, k, t: BACK(d, changed(k, focal=slice(0, 1)), t),
        "fy for fx": lambda d, k, t: BACK(d, changed(k, focal=slice(1, 2)), t),
        "middle of the picture typed": lambda d, k, t: BACK(d, changed(k, by=1.0), t),
        "pose transposed": lambda d, k, t: BACK(d, k, t.T),
        "place of the camera left out": lambda d, k, t: BACK(d, k, t) - t[:3, 3],
        "place of the camera subtracted": lambda d, k, t: BACK(d, k, t) - 2 * t[:3, 3],
        "one depth for all": lambda d, k, t: BACK(np.full_like(d, d.mean()), k, t),
        "a list of points": lambda *given: BACK(*given).reshape(-1, 3),
        "millimetres": lambda *given: 1000 * BACK(*given),
        "size typed": lambda d, k, t: BACK(np.resize(d, (20, 32)), k, t),
        "depth changed": in_place(BACK, 0),
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in CASES.items() for how in of])
def test_only_right_solutions_pass(reaches, name, how):
    more = {"forward": (reaches.traces["baseline"],)}.get(name, ())
    check = getattr(exercises, name)(CASES[name][how], *more)
    assert check.passed == how.startswith("right"), check.detail
