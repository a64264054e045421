"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

import numpy as np
import pytest

from robo_genesis.lessons.l05 import exercises
from robo_genesis.sim import arm_kinematics as of


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


def negative(q, links):
    """The other quaternion of the same rotation."""
    position, quat = forward(q, links)
    return position, -quat


def accept(q, error, most, angle):
    return bool(of.accepted(q, error, most, angle))


RIGHT = {
    "forward": {"chain": forward, "negative quaternion": negative},
    "step": {
        "ours": of.damped_step,
        "other side": lambda J, e, d: np.linalg.solve(J.T @ J + d**2 * np.eye(J.shape[1]), J.T @ e),
    },
    "acceptance": {"ours": accept},
}
WRONG = {
    "forward": {
        "offsets not turned": lambda q, n: forward(q, n, turned=lambda quat, v: v),
        "product in the other order": lambda q, n: forward(
            q, n, multiply=lambda a, b: of.quat_multiply(b, a)
        ),
        "degrees": lambda q, n: forward(q, n, angle=np.pi / 180),
        "the hand turns": lambda q, n: forward(q, n, fixed_last=False),
        "joint before offset": turned_before_offset,
        "xyzw": xyzw,
        "always the whole chain": lambda q, n: forward(q, of.CHAIN),
        "not written": lambda q, n: None,
    },
    "step": {
        "no damping": lambda J, e, d: np.linalg.pinv(J) @ e,
        "damping not squared": lambda J, e, d: of.damped_step(J, e, np.sqrt(d)),
        "gradient": lambda J, e, d: J.T @ e,
        "away from the target": lambda J, e, d: -of.damped_step(J, e, d),
        "six rows alone": lambda J, e, d: J.T @ np.linalg.solve(J @ J.T + d**2 * np.eye(6), e),
    },
    "acceptance": {
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
}


@pytest.fixture
def tested(reaches):
    more = {"forward": (reaches.traces["baseline"],)}
    return lambda name, function: getattr(exercises, name)(function, *more.get(name, ()))


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in RIGHT.items() for how in of])
def test_a_right_solution_passes(tested, name, how):
    (check,) = tested(name, RIGHT[name][how])
    assert check.passed, check.detail


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in WRONG.items() for how in of])
def test_a_wrong_solution_fails_and_is_told_what_was_found(tested, name, how):
    (check,) = tested(name, WRONG[name][how])
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail or "cannot" in check.detail
