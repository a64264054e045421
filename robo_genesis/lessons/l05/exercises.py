"""Checks of the kinematic functions that a student writes in L05's lab; see `core/exercises.py`."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from robo_genesis.core.checks import Check, Finding, at_most, below, equal
from robo_genesis.core.exercises import outcome
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l05 import spec
from robo_genesis.lessons.l05.metrics import measured_hand
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim.arm_kinematics import ARM, CHAIN, Pose

CLOSE = 5e-6
"""Largest difference to a pose of the engine, which computes in float32 [m or rad]."""

TINY = 1e-9
"""Largest difference that rounding explains in float64."""

SINGULAR = np.array([0.0, 0.0, 0.0, -0.07, 0.0, 1.6, 0.0])
"""A nearly stretched arm: the smallest singular value of its Jacobian is about 0.01."""


def forward(chain: Callable[..., Any], trace: Trace) -> list[Check]:
    """Check `chain(q, links)`: the pose of the last link, by the links of a chain.

    `q` (7,) are the joint positions; `links` are names, positions and orientations as in `CHAIN`.
    The function returns a position (3,) [m] and a quaternion (4,) of either sign. It is compared
    with the engine in recorded postures, and with two parts of the chain.
    """

    def findings(_: None) -> Iterator[Finding]:
        for state in (0, trace.steps // 8, trace.steps):
            q = trace.q[state, :ARM].astype(float)
            yield from near(f"state_{state}", chain(q, CHAIN), measured_hand(trace, state), CLOSE)
        q = np.array([0.3, -0.4, 0.5, -1.6, 0.7, 1.1, -0.2])
        poses = kinematics.link_poses(q)
        for count in (1, 4):
            expected = Pose(poses.position[count - 1], poses.quat[count - 1])
            yield from near(f"first_{count}_links", chain(q, CHAIN[:count]), expected, TINY)

    return outcome("forward", findings)


def near(label: str, found: Any, expected: Pose, tiny: float) -> Iterator[Finding]:
    """Require a pose of the right shapes that differs from the expected one by rounding."""
    position, quat = (np.asarray(part, dtype=float) for part in found)
    yield equal(f"{label}.shapes", [list(position.shape), list(quat.shape)], [[3], [4]])
    if (position.shape, quat.shape) == ((3,), (4,)):
        yield at_most(f"{label}.norm_error", abs(float(np.linalg.norm(quat)) - 1), 1e-5)
        error = kinematics.pose_error(expected, Pose(position, quat))
        apart, angle = kinematics.distances(error)
        yield at_most(f"{label}.distance_m", float(apart), tiny)
        yield at_most(f"{label}.angle_rad", float(angle), tiny)


def step(damped: Callable[..., Any]) -> list[Check]:
    """Check `damped(J, error, damping)`: one step (n,) of damped least squares.

    `J` is (m, n), `error` (m,). The postures are the start and a nearly singular one; a step with
    little damping must bring the hand nearer.
    """

    def findings(_: None) -> Iterator[Finding]:
        start = np.array(spec.BASELINE.q_start[:ARM])
        target = Pose(spec.TARGET, spec.DOWN)
        postures = {"start": start, "nearly_singular": SINGULAR}
        for name, q in postures.items():
            of = kinematics.jacobian(q)
            error = kinematics.pose_error(target, kinematics.hand_pose(q))
            for damping in (0.01, 0.3):
                label, right = f"{name}_{damping:g}", kinematics.damped_step(of, error, damping)
                found = np.asarray(damped(of, error, damping), dtype=float)
                yield equal(f"{label}.shape", list(found.shape), [ARM])
                if found.shape == (ARM,):
                    yield at_most(f"{label}.distance_rad", float(np.abs(found - right).max()), TINY)
        of, error = kinematics.jacobian(start)[:3], np.array([0.01, 0.0, -0.01])
        moved = start + np.asarray(damped(of, error, 0.01), dtype=float).reshape(ARM)
        left = kinematics.hand_pose(start).position + error - kinematics.hand_pose(moved).position
        yield below("position_only.distance_left_m", float(np.linalg.norm(left)), 1e-3)

    return outcome("step", findings)


ANSWERS: dict[str, tuple[tuple[float, ...], tuple[float, ...], bool]] = {
    "exact": ((0.1,) * 9, (0.0,) * 6, True),
    "within_both": ((0.1,) * 9, (3e-4, 0, 0, 0, 4e-3, 0), True),
    "at_both_limits": ((0.1,) * 9, (5e-4, 0, 0, 0, 0, 5e-3), True),
    "too_far": ((0.1,) * 9, (6e-4, 0, 0, 0, 0, 0), False),
    "too_far_backwards": ((0.1,) * 9, (0, 0, -2.0, 0, 0, 0), False),
    "too_far_along_the_diagonal": ((0.1,) * 9, (4e-4, 4e-4, 0, 0, 0, 0), False),
    "turned_too_far": ((0.1,) * 9, (0, 0, 0, 0, -6e-3, 0), False),
    "turned_too_far_about_two_axes": ((0.1,) * 9, (0, 0, 0, 4e-3, 4e-3, 0), False),
    "opposite_errors": ((0.1,) * 9, (0.2, -0.2, 0, 0.2, -0.2, 0), False),
    "joint_not_a_number": ((0.1,) * 8 + (np.nan,), (0.0,) * 6, False),
    "joint_infinite": ((np.inf,) + (0.1,) * 8, (0.0,) * 6, False),
    "residual_not_a_number": ((0.1,) * 9, (np.nan,) + (0.0,) * 5, False),
}
"""Joint positions, residual, and whether they may be commanded with the tolerances of `IK`."""


def acceptance(accept: Callable[..., Any]) -> list[Check]:
    """Check `accept(q, error, position_tolerance, rotation_tolerance)` with invented answers."""

    def findings(_: None) -> Iterator[Finding]:
        tolerances = spec.IK.position_tolerance, spec.IK.rotation_tolerance
        for name, (q, error, right) in ANSWERS.items():
            found = accept(np.array(q), np.array(error, dtype=float), *tolerances)
            yield equal(name, bool(found), right)
        yield equal("looser_tolerances", bool(accept(np.zeros(9), np.full(6, 0.1), 0.2, 0.2)), True)

    return outcome("acceptance", findings)
