"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

import numpy as np
import pytest

from robo_genesis.lessons.l05 import exercises
from robo_genesis.sim.arm import kinematics as of
from robo_genesis.sim.camera import geometry as cameras


def forward(q, links, multiply=of.quat_multiply, turned=of.rotate, angle=1.0, fixed_last=True):
    """Chain the transforms; the other arguments make mistakes."""
    position, quat = np.zeros(3), np.array([1.0, 0, 0, 0])
    for k, (_, offset, orientation) in enumerate(links):
        position = position + turned(quat, np.array(offset))
        quat = multiply(quat, np.array(orientation))
        if k < 7 or not fixed_last:
            quat = multiply(quat, of.about_z(angle * q[k % 7]))
    return position, quat


def turned_before_offset(q, links):
    """Turn each joint before its link's fixed transform."""
    position, quat = np.zeros(3), np.array([1.0, 0, 0, 0])
    for k, (_, offset, orientation) in enumerate(links):
        if k < 7:
            quat = of.quat_multiply(quat, of.about_z(q[k]))
        position = position + of.rotate(quat, np.array(offset))
        quat = of.quat_multiply(quat, np.array(orientation))
    return position, quat


def xyzw(q, links):
    position, quat = forward(q, links)
    return position, np.roll(quat, -1)


def not_written(*_):
    raise NotImplementedError("write it")


def negative(q, links):
    """The other quaternion of the same rotation."""
    position, quat = forward(q, links)
    return position, -quat


def lifted(depth, K, transform, half=0.5, flip=cameras.FLIP, along=False, swap=False):
    """Return back-projected pixels, with one mistake."""
    v, u = np.indices(depth.shape) + half
    u, v = (v, u) if swap else (u, v)
    unit = np.dstack([u, v, np.ones(depth.shape)]) @ np.linalg.inv(K).T
    if along:
        unit /= np.linalg.norm(unit, axis=-1, keepdims=True)
    pose = transform @ flip
    return (unit * depth[..., None]) @ pose[:3, :3].T + pose[:3, 3]


def flattened(points, K, transform, flip=cameras.FLIP):
    """Return projected points, with the given turn of the axes."""
    pose = transform @ flip
    seen = (points - pose[:3, 3]) @ pose[:3, :3]
    return (seen / seen[:, 2:] @ K.T)[:, :2]


def accept(q, error, most, angle):
    return bool(of.accepted(q, error, most, angle))


CASES = {
    "forward": {
        "right": forward,
        "right, negative quaternion": negative,
        "offsets not turned": lambda q, n: forward(q, n, turned=lambda quat, v: v),
        "product in the other order": lambda q, n: forward(
            q, n, multiply=lambda a, b: of.quat_multiply(b, a)
        ),
        "degrees": lambda q, n: forward(q, n, angle=np.pi / 180),
        "the hand turns": lambda q, n: forward(q, n, fixed_last=False),
        "joint before offset": turned_before_offset,
        "the fifth joint left out": lambda q, n: forward(q * (np.arange(7) != 4), n),
        "xyzw": xyzw,
        "always the whole chain": lambda q, n: forward(q, of.CHAIN),
        "nothing returned": lambda q, n: None,
    },
    "step": {
        "right": of.damped_step,
        "right, other side": lambda J, e, d: np.linalg.solve(
            J.T @ J + d**2 * np.eye(J.shape[1]), J.T @ e
        ),
        "no damping": lambda J, e, d: np.linalg.pinv(J) @ e,
        "damping not squared": lambda J, e, d: of.damped_step(J, e, np.sqrt(d)),
        "gradient": lambda J, e, d: J.T @ e,
        "away from the target": lambda J, e, d: -of.damped_step(J, e, d),
        "six rows alone": lambda J, e, d: J.T @ np.linalg.solve(J @ J.T + d**2 * np.eye(6), e),
    },
    "acceptance": {
        "right": accept,
        "always": lambda q, e, most, angle: True,
        "signed": lambda q, e, most, angle: bool((e[:3] <= most).all() and (e[3:] <= angle).all()),
        "each entry": lambda q, e, most, angle: bool(
            (abs(e[:3]) <= most).all() and (abs(e[3:]) <= angle).all()
        ),
        "position alone": lambda q, e, most, angle: bool(
            np.isfinite(q).all() and np.linalg.norm(e[:3]) <= most
        ),
        "q not looked at": lambda q, e, most, angle: bool(
            np.linalg.norm(e[:3]) <= most and np.linalg.norm(e[3:]) <= angle
        ),
        "one norm of six": lambda q, e, most, angle: bool(
            np.isfinite(q).all() and np.linalg.norm(e) <= most
        ),
        "typed tolerances": lambda q, e, most, angle: accept(q, e, 5e-4, 5e-3),
    },
    "project": {
        "right": flattened,
        "u and v swapped": lambda *given: flattened(*given)[:, ::-1],
        "OpenGL axes": lambda *given: flattened(*given, flip=np.eye(4)),
        "centre of pixels at whole numbers": lambda *given: flattened(*given) - 0.5,
        "not divided by the depth": lambda p, k, t: (cameras.in_camera(p, t) @ k.T)[:, :2],
        "from camera to world": lambda p, k, t: flattened(p, k, np.linalg.inv(t)),
        "one point alone": lambda p, k, t: flattened(p[:1], k, t)[0],
        "not written": not_written,
    },
    "back_project": {
        "right": lifted,
        "u and v swapped": lambda *given: lifted(*given, swap=True),
        "rows and columns swapped": lambda *given: np.swapaxes(lifted(*given), 0, 1),
        "OpenGL axes": lambda *given: lifted(*given, flip=np.eye(4)),
        "depth along the ray": lambda *given: lifted(*given, along=True),
        "half a pixel missing": lambda *given: lifted(*given, half=0.0),
        "camera coordinates": lambda d, k, t: lifted(d, k, cameras.FLIP),
        "not written": not_written,
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in CASES.items() for how in of])
def test_only_right_solutions_pass(reaches, name, how):
    more = {"forward": (reaches.traces["baseline"],)}.get(name, ())
    (check,) = getattr(exercises, name)(CASES[name][how], *more)
    assert check.passed == how.startswith("right"), check.detail
