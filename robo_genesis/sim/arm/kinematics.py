"""Kinematics of the Franka's arm in NumPy: rotations, poses, Jacobian and damped least squares.

`hand_pose` takes other robots as well. For their links and Jacobian there is
`sim/mujoco/kinematics.py`.

Quaternions are (w, x, y, z) of unit length. All functions take leading dimensions `…`,
so one call handles one posture or many. Positions are in metres, angles in radians. The
frame is that of the world, and the base of the arm is at its origin.
"""

from typing import NamedTuple

import numpy as np

from robo_genesis.core.scene import FloatArray, read_only
from robo_genesis.core.trace import Trace

from .franka import FRANKA, LINK_PARENTS
from .model import RobotModel

HALF = np.sqrt(0.5)

# Name of each link, its position [m] and orientation in its parent, as in the model
# file.
#
# The parent of the first is the base. Then each of the seven arm links turns by its
# joint's angle about its own z axis. The hand is fixed to the last of them.
CHAIN = (
    ("link1", (0.0, 0.0, 0.333), (1.0, 0.0, 0.0, 0.0)),
    ("link2", (0.0, 0.0, 0.0), (HALF, -HALF, 0.0, 0.0)),
    ("link3", (0.0, -0.316, 0.0), (HALF, HALF, 0.0, 0.0)),
    ("link4", (0.0825, 0.0, 0.0), (HALF, HALF, 0.0, 0.0)),
    ("link5", (-0.0825, 0.384, 0.0), (HALF, -HALF, 0.0, 0.0)),
    ("link6", (0.0, 0.0, 0.0), (HALF, HALF, 0.0, 0.0)),
    ("link7", (0.088, 0.0, 0.0), (HALF, HALF, 0.0, 0.0)),
    ("hand", (0.0, 0.0, 0.107), (0.9238795, 0.0, 0.0, -0.3826834)),
)

# Orientation (w, x, y, z) of the hand with the fingers down: half a turn about x.
DOWN = read_only((0.0, 1.0, 0.0, 0.0))

ARM = len(CHAIN) - 1  # Number of joints of the arm

# From the hand's origin to the ends of the fingers, along its z axis [m]
TIP = FRANKA.tip

# Index of the hand among the links of the arrays: the parent of both fingers.
HAND = LINK_PARENTS[-1]


class Pose(NamedTuple):
    """Position (…, 3) [m] and orientation (…, 4) of a frame in another one."""

    position: FloatArray
    quat: FloatArray


def quat_multiply(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the product (…, 4): the rotation by `second`, then by `first`."""
    w, x, y, z = np.moveaxis(np.asarray(first, dtype=float), -1, 0)
    a, b, c, d = np.moveaxis(np.asarray(second, dtype=float), -1, 0)
    parts = (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )
    return np.stack(parts, axis=-1)


def rotate(quat: FloatArray, vector: FloatArray) -> FloatArray:
    """Return the vector (…, 3) turned by the quaternion (…, 4)."""
    quat, vector = np.asarray(quat, dtype=float), np.asarray(vector, dtype=float)
    w, axis = quat[..., :1], quat[..., 1:]
    twice = 2.0 * np.cross(axis, vector)
    return vector + w * twice + np.cross(axis, twice)


def about_z(angle: FloatArray) -> FloatArray:
    """Return the quaternions (…, 4) of rotations about z by angles (…) [rad]."""
    half, zero = np.asarray(angle, dtype=float) / 2, np.zeros(np.shape(angle))
    return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=-1)


def rotation_vector(quat: FloatArray) -> FloatArray:
    """Return axis times angle (…, 3) [rad], with an angle from 0 to π.

    A quaternion and its negative are one rotation, so both give the same vector.
    """
    quat = np.asarray(quat, dtype=float)
    quat = np.where(quat[..., :1] < 0, -quat, quat)
    length = np.linalg.norm(quat[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(length, quat[..., :1])
    factor = np.divide(
        angle, length, out=np.full_like(length, 2.0), where=length > 1e-12
    )
    return quat[..., 1:] * factor


def link_poses(q: FloatArray) -> Pose:
    """Return the poses of the links of `CHAIN` by forward kinematics.

    Args:
        q: (…, 7 or more) joint positions; the arm's are the first seven [rad].

    Returns:
        Positions (…, 8, 3) [m] and orientations (…, 8, 4).
    """
    q = np.asarray(q, dtype=float)
    # of the link before, first the base
    at, turn = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    positions, quats = [], []
    for k, (_, position, quat) in enumerate(CHAIN):
        at = at + rotate(turn, np.array(position))
        turn = quat_multiply(turn, np.array(quat))
        if k < ARM:
            turn = quat_multiply(turn, about_z(q[..., k]))
        positions.append(np.broadcast_to(at, (*q.shape[:-1], 3)))
        quats.append(np.broadcast_to(turn, (*q.shape[:-1], 4)))
    return Pose(np.stack(positions, axis=-2), np.stack(quats, axis=-2))


def hand_pose(q: FloatArray, of: RobotModel = FRANKA) -> Pose:
    """Return the pose of a robot's hand, (…, 3) and (…, 4), at joint positions (…, d) [rad or m].

    Of the Franka the first seven are enough. The poses of others come from MuJoCo.
    """
    if of == FRANKA:
        poses = link_poses(q)
        return Pose(poses.position[..., -1, :], poses.quat[..., -1, :])
    from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

    rows = np.reshape(q, (-1, np.shape(q)[-1]))
    poses = mujoco_kinematics.link_poses(rows, [of.hand], of)
    return Pose(*(part.reshape(*np.shape(q)[:-1], -1) for part in poses))


def jacobian(q: FloatArray) -> FloatArray:
    """Return the geometric Jacobian (…, 6, 7) of the hand's origin.

    Column k is the hand's velocity [m/s] above its angular velocity [rad/s], both in
    the axes of the world, while joint k turns with 1 rad/s and the others rest.

    Args:
        q: (…, 7 or more) joint positions; the arm's are the first seven [rad].
    """
    poses = link_poses(q)
    axes = rotate(poses.quat[..., :ARM, :], np.array([0.0, 0.0, 1.0]))  # (…, 7, 3)
    arms = poses.position[..., -1:, :] - poses.position[..., :ARM, :]
    columns = np.concatenate([np.cross(axes, arms), axes], axis=-1)  # (…, 7, 6)
    return np.swapaxes(columns, -1, -2)


def manipulability(of: FloatArray) -> FloatArray:
    """Return √det(J Jᵀ) (…), the product of the singular values of a Jacobian (…, 6, n)."""
    return np.prod(np.linalg.svd(of, compute_uv=False), axis=-1)


def pose_error(target: Pose, pose: Pose) -> FloatArray:
    """Return the motion (…, 6) that leads from a pose to its target, in the axes of the world.

    The first three entries are a translation [m], the others a rotation vector [rad].
    """
    opposite = pose.quat * np.array([1.0, -1.0, -1.0, -1.0])
    turn = rotation_vector(quat_multiply(target.quat, opposite))
    return np.concatenate([target.position - pose.position, turn], axis=-1)


def distances(error: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the lengths (…) [m] and (…) [rad] of both parts of pose errors (…, 6)."""
    return np.linalg.norm(error[..., :3], axis=-1), np.linalg.norm(
        error[..., 3:], axis=-1
    )


def measured_hand(trace: Trace, state: int | slice) -> Pose:
    """Return the pose of the hand in one state of a run or several, as the engine reported it."""
    at, quat = (
        of[state, HAND].astype(np.float64) for of in (trace.link_pos, trace.link_quat)
    )
    return Pose(at, quat / np.linalg.norm(quat, axis=-1, keepdims=True))


def distance_and_angle(target: Pose, pose: Pose) -> tuple[float, float]:
    """Return distance [m] and angle [rad] of a pose from another one."""
    apart, angle = distances(pose_error(target, pose))
    return float(apart), float(angle)


def accepted(
    q: FloatArray,
    error: FloatArray,
    position_tolerance: float,
    rotation_tolerance: float,
) -> np.ndarray:
    """Return whether (…) answers of a solver may be commanded: finite, residual within tolerance.

    Args:
        q: (…, d) joint positions [rad or m].
        error: (…, 6) residual pose errors [m and rad].
        position_tolerance: largest accepted length of the first three entries [m].
        rotation_tolerance: largest accepted length of the others [rad].
    """
    finite = np.isfinite(q).all(axis=-1) & np.isfinite(error).all(axis=-1)
    apart, angle = distances(error)
    return finite & (apart <= position_tolerance) & (angle <= rotation_tolerance)


def fingertip(pose: Pose, tip: float = TIP) -> FloatArray:
    """Return the point (…, 3) between the fingertips for a pose of the hand [m]."""
    return pose.position + rotate(pose.quat, np.array([0.0, 0.0, tip]))


def overshoot_along_line(path: FloatArray, target: FloatArray) -> float:
    """Return how far a path (n+1, 3) leads past a target (3,), on the line from its start [m]."""
    way = np.asarray(path - target, dtype=float)
    return max(0.0, (way @ -way[0]).max() / np.linalg.norm(way[0]))


def damped_step(of: FloatArray, error: FloatArray, damping: float) -> FloatArray:
    """Return the step Jᵀ (J Jᵀ + λ² I)⁻¹ e of damped least squares (…, n) [rad].

    Args:
        of: Jacobian (…, m, n).
        error: (…, m).
        damping: λ, in the unit of the Jacobian.
    """
    across = np.swapaxes(of, -1, -2)
    normal = of @ across + damping**2 * np.eye(of.shape[-2])
    return (across @ np.linalg.solve(normal, error[..., None]))[..., 0]


def limit_margin(q: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Return the distance (…) of the joint that is nearest to one of its limits, negative beyond.

    Args:
        q: (…, n) joint positions [rad].
        lower: (n,) limits [rad].
        upper: (n,) limits [rad].
    """
    return np.minimum(q - lower, upper - q).min(axis=-1)
