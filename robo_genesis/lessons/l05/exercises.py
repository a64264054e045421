"""Checks of the five functions that a student writes in L05's lab; see `core/exercises.py`."""

from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.exercises import Written, as_test, same_array
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.kinematics import ARM, CHAIN, Pose, measured_hand
from robo_genesis.sim.arm.reaching import ANSWERS
from robo_genesis.sim.camera import geometry as cameras

from . import spec

MEASURES = False

TINY = 1e-9  # Largest difference that rounding explains in float64

# Largest difference of a pixel coordinate [pixel] or of a point [m] that rounding
# explains.
ROUNDED = 1e-6

# Columns and rows of the invented cameras.
SIZE, OTHER = (32, 20), (24, 18)

# The pose of an invented camera that looks down, z backwards [m].
TURNED = cameras.looking((1.1, -0.7, 0.9), (0.46, -0.22, 0.3))

# Camera matrix and pose of each invented camera.
CAMERAS = {
    "straight": (cameras.intrinsics(60.0, SIZE), np.eye(4)),
    "turned": (cameras.intrinsics(42.0, SIZE), TURNED),
    "not_square": (cameras.intrinsics(42.0, OTHER) * [[1.1], [1.25], [1]], TURNED),
}


@as_test
def forward(chain: Written, trace: Trace) -> Findings:
    """Check `chain(q, links)`: the pose of the last link, by the links of a chain.

    `q` (7,) are the joint positions; `links` are names, positions and orientations as
    in `CHAIN`. The function returns a position (3,) [m] and a quaternion (4,) of either
    sign. It is compared with the engine in recorded postures, and with our chain and
    its first links in another one.
    """
    for state in (0, trace.steps // 8, trace.steps):
        q, hand = trace.q[state, :ARM].astype(float), measured_hand(trace, state)
        yield from near(f"state_{state}", chain(q, CHAIN), hand, spec.SAME_POSE[0])
    q = np.array([0.3, -0.4, 0.5, -1.6, 0.7, 1.1, -0.2])
    poses = kinematics.link_poses(q)
    for count in (1, 4, len(CHAIN)):
        expected = Pose(poses.position[count - 1], poses.quat[count - 1])
        yield from near(f"first_{count}_links", chain(q, CHAIN[:count]), expected, TINY)


def near(label: str, found: Any, expected: Pose, tiny: float) -> Findings:
    """Require a pose that differs by rounding; the quaternion may have the other sign."""
    position, quat = found
    yield from same_array(f"{label}.position_m", position, expected.position, tiny)
    right = expected.quat
    if np.shape(quat) == right.shape and np.dot(quat, right) < 0:
        right = -right
    yield from same_array(f"{label}.quaternion", quat, right, tiny)


@as_test
def step(damped: Written) -> Findings:
    """Check `damped(J, error, damping)`: one step (n,) of damped least squares.

    `J` is (m, n), `error` (m,). The postures are the start and a nearly singular one.
    """
    start = np.array(spec.BASELINE.q_start[:ARM])
    target = Pose(spec.TARGET, spec.DOWN)
    given: dict[str, Any] = {
        f"{rows}_rows": (
            kinematics.jacobian(start)[:rows, : rows - 1],
            np.linspace(-0.01, 0.02, rows),
        )
        for rows in (3, 6)
    }
    for name, q in (("start", start), ("nearly_singular", spec.NEARLY_STRETCHED)):
        error = kinematics.pose_error(target, kinematics.hand_pose(q))
        given[name] = kinematics.jacobian(q), error
    for name, (of, error) in given.items():
        for damping in (0.01, 0.3):
            right = kinematics.damped_step(of, error, damping)
            found = damped(of, error, damping)
            yield from same_array(f"{name}_{damping:g}", found, right, TINY)


@as_test
def acceptance(accept: Written) -> Findings:
    """Check `accept(q, error, clearance, position_tolerance, rotation_tolerance, least)`.

    The answers are invented.
    """
    limits = (*spec.IK.tolerances, spec.IK.clearance)
    for name, ((joint, value), error, right) in ANSWERS.items():
        q = np.where(np.arange(9) == joint, value, 0.1)
        found = accept(q, np.array(error, dtype=float), 0.1, *limits)
        yield equal(name, found, right)
    loose = accept(np.zeros(9), np.full(6, 0.1), 0.01, 0.2, 0.2, 0.01)
    yield equal("looser", loose, True)
    for clearance, right in ((0.03, True), (0.029, False), (-0.04, False)):
        found = accept(np.zeros(9), np.zeros(6), clearance, *limits)
        yield equal(f"clearance_{clearance:g}", found, right)


@as_test
def project(function: Written) -> Findings:
    """Check `project(points, K, transform)`: pixel coordinates (n, 2) of points (n, 3).

    The corner of the picture is (0, 0). `transform` is the engine's: x right, y up, z
    backwards.
    """
    # Some are beside the picture, one is far, one near.
    seen = np.array(
        [
            [0, 0, 1],
            [0.3, 0, 1],
            [0, 0.2, 1],
            [-4, 1, 2],
            [1, 3, 0.5],
            [1, 2, 30],
            [0, 0.01, 0.05],
        ]
    )
    for name, (K, transform) in CAMERAS.items():
        pose = cameras.other_axes(transform)
        points = seen @ pose[:3, :3].T + pose[:3, 3]
        expected = cameras.project(points, K, transform)
        yield from same_array(name, function(points, K, transform), expected, ROUNDED)
        behind = seen * (1, 1, -1) @ pose[:3, :3].T + pose[:3, 3]
        found = np.asarray(function(np.vstack([behind, points]), K, transform))
        missing = np.isnan(found).all(axis=1)
        right = [True] * 7 + [False] * 7
        yield equal(f"{name}.without_a_pixel", missing.tolist(), right)
        label = f"{name}.beside_points_without"
        yield from same_array(label, found[7:], expected, ROUNDED)


@as_test
def back_project(function: Written) -> Findings:
    """Check `back_project(depth, K, transform)`: the point (H, W, 3) of each pixel's centre.

    `depth` (H, W) is measured along the optical axis. The pictures are of a plane in
    front of the camera, where depth is constant, and of a sloping one.
    """
    for name, camera in CAMERAS.items():
        width, height = OTHER if name == "not_square" else SIZE
        rows, columns = np.mgrid[:height, :width]
        sloping = 1 + 0.02 * rows + 0.01 * columns
        depths = {"flat": np.full((height, width), 1.5), "sloping": sloping}
        for kind, depth in depths.items():
            expected = cameras.back_project(depth, *camera)
            found = function(depth, *camera)
            yield from same_array(f"{name}.{kind}", found, expected, ROUNDED)
