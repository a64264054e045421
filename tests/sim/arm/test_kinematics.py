"""Rotations, poses, Jacobian and damped least squares against MuJoCo and differences."""

import numpy as np
import pytest

from robo_genesis.lessons.l05 import spec
from robo_genesis.sim.arm import kinematics as of
from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

POSTURES = np.vstack([Q_START, spec.RANDOM_STARTS[:5]])
DOWN = of.Pose(spec.TARGET, spec.DOWN)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.5, np.pi, 3.3])
def test_a_rotation_vector_has_the_shorter_angle(angle):
    found = of.rotation_vector(of.about_z(np.array(angle)))
    expected = angle if angle <= np.pi else angle - 2 * np.pi
    assert found == pytest.approx([0, 0, expected], abs=1e-12)


def test_poses_and_jacobian_of_many_postures_agree_with_mujoco_and_with_differences():
    poses = of.Pose(
        *mujoco_kinematics.link_poses(POSTURES, [name for name, *_ in of.CHAIN])
    )
    # The model file gives the hand's orientation with seven digits.
    assert np.abs(of.pose_error(poses, of.link_poses(POSTURES))).max() < 1e-7
    many, h = of.jacobian(POSTURES), 1e-6
    for rows, q in zip(many, POSTURES, strict=True):
        assert rows == pytest.approx(mujoco_kinematics.jacobian(q)[:, :7], abs=1e-7)
        ends = (of.hand_pose(q + sign * h * np.eye(9)[:7]) for sign in (1, -1))
        assert of.pose_error(*ends) / (2 * h) == pytest.approx(rows.T, abs=1e-7)


def test_a_pose_error_leads_to_the_target():
    pose = of.hand_pose(Q_START)
    error = of.pose_error(DOWN, pose)
    angle = np.linalg.norm(error[3:])
    turn = np.append(np.cos(angle / 2), np.sin(angle / 2) * error[3:] / angle)
    reached = of.Pose(pose.position + error[:3], of.quat_multiply(turn, pose.quat))
    assert of.pose_error(DOWN, reached) == pytest.approx(np.zeros(6), abs=1e-9)


def test_the_margin_is_that_of_the_nearest_limit():
    lower, upper = spec.ARM_LIMITS
    q = (lower + upper) / 2
    q[2] = upper[2] - 0.1
    assert of.limit_margin(q, lower, upper) == pytest.approx(0.1)
    q[4] = lower[4] - 0.2
    assert of.limit_margin(q, lower, upper) == pytest.approx(-0.2)


@pytest.mark.parametrize(
    ("ways", "expected"),
    [([0, 3, 5, 4], 0.0), ([0, 3, 7, 5.5], 2.0), ([0, -1, 5], 0.0)],
)
def test_an_overshoot_is_measured_along_the_line_from_the_start(ways, expected):
    along, aside = np.array([0.6, 0.8, 0.0]), np.array([-0.8, 0.6, 0.0])
    path = np.outer(ways, along) + np.outer(np.arange(len(ways)), aside)
    found = of.overshoot_along_line(path, 5 * along)
    assert found == pytest.approx(expected)
