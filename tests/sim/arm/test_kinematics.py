"""Rotations, poses, Jacobian and damped least squares against MuJoCo and differences."""

import numpy as np
import pytest

from robo_genesis.lessons.l05 import spec
from robo_genesis.sim.arm import kinematics as of
from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

POSTURES = np.vstack([Q_START, spec.RANDOM_STARTS[:20]])
LINKS = [name for name, *_ in of.CHAIN]
DOWN = of.Pose(spec.TARGET, spec.DOWN)


@pytest.mark.parametrize(
    ("quat", "vector", "turned"),
    [
        ((1, 0, 0, 0), (1, 2, 3), (1, 2, 3)),
        ((0, 1, 0, 0), (1, 2, 3), (1, -2, -3)),
        ((of.HALF, 0, 0, of.HALF), (1, 0, 0), (0, 1, 0)),
        ((-of.HALF, 0, 0, -of.HALF), (1, 0, 0), (0, 1, 0)),
    ],
)
def test_a_quaternion_turns_a_vector_and_its_negative_does_the_same(quat, vector, turned):
    assert of.rotate(np.array(quat), np.array(vector)) == pytest.approx(turned)


def test_a_product_turns_by_the_second_factor_first():
    about_x, about_z = np.array([of.HALF, of.HALF, 0, 0]), of.about_z(np.pi / 2)
    product, up = of.quat_multiply(about_z, about_x), np.array([0.0, 0.0, 1.0])
    assert of.rotate(product, up) == pytest.approx(of.rotate(about_z, of.rotate(about_x, up)))
    assert of.rotate(product, up) == pytest.approx([1, 0, 0])  # about_x takes z to -y


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.5, 3.0, np.pi, 3.3])
def test_a_rotation_vector_has_the_shorter_angle(angle):
    found = of.rotation_vector(of.about_z(np.array(angle)))
    expected = angle if angle <= np.pi else angle - 2 * np.pi
    assert found == pytest.approx([0, 0, expected], abs=1e-12)


def test_forward_kinematics_agrees_with_mujoco_for_every_link():
    position, quat = mujoco_kinematics.link_poses(POSTURES, LINKS)
    error = of.pose_error(of.Pose(position, quat), of.link_poses(POSTURES))
    # The model file gives the hand's orientation with seven digits.
    assert np.abs(error).max() < 1e-7


def test_one_posture_and_many_give_the_same():
    many = of.hand_pose(POSTURES)
    one = of.hand_pose(POSTURES[3])
    assert (many.position[3] == one.position).all()
    assert of.jacobian(POSTURES)[3] == pytest.approx(of.jacobian(POSTURES[3]))


@pytest.mark.parametrize("q", POSTURES[:5])
def test_the_jacobian_agrees_with_mujoco_and_with_differences(q):
    rows, h = of.jacobian(q), 1e-6
    assert rows == pytest.approx(mujoco_kinematics.jacobian(q, "hand")[:, :7], abs=1e-7)
    for k in range(7):
        ends = [of.hand_pose(q + sign * h * np.eye(9)[k]) for sign in (1, -1)]
        assert of.pose_error(*ends) / (2 * h) == pytest.approx(rows[:, k], abs=1e-7)


def test_manipulability_is_the_root_of_the_determinant_and_vanishes_at_a_singularity():
    rows = of.jacobian(Q_START)
    assert of.manipulability(rows) == pytest.approx(np.sqrt(np.linalg.det(rows @ rows.T)))
    rows[2] = rows[1]
    assert of.manipulability(rows) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("q", POSTURES[:3])
def test_a_pose_error_leads_to_the_target(q):
    pose = of.hand_pose(q)
    error = of.pose_error(DOWN, pose)
    angle = np.linalg.norm(error[3:])
    turn = np.append(np.cos(angle / 2), np.sin(angle / 2) * error[3:] / angle)
    reached = of.Pose(pose.position + error[:3], of.quat_multiply(turn, pose.quat))
    assert of.pose_error(DOWN, reached) == pytest.approx(np.zeros(6), abs=1e-9)


def test_a_damped_step_minimises_error_and_step_together():
    rows, error, damping = of.jacobian(Q_START), np.arange(1.0, 7.0) / 100, 0.1
    step = of.damped_step(rows, error, damping)
    assert rows.T @ (rows @ step - error) + damping**2 * step == pytest.approx(np.zeros(7))
    assert np.linalg.norm(of.damped_step(rows, error, 10.0)) < np.linalg.norm(step)


def test_the_solver_reaches_the_target_within_the_limits_and_stops_short_of_one_beyond_reach():
    q = of.solve(DOWN, Q_START[:7], *spec.ARM_LIMITS, iterations=100, damping=0.01)
    error = of.pose_error(DOWN, of.hand_pose(q))
    assert of.accepted(q, error, 5e-4, 5e-3)
    assert of.limit_margin(q, *spec.ARM_LIMITS) > 0
    far = of.Pose(spec.BEYOND_REACH, spec.DOWN)
    q = of.solve(far, Q_START[:7], *spec.ARM_LIMITS, iterations=100, damping=0.1)
    error = of.pose_error(far, of.hand_pose(q))
    assert np.isfinite(q).all()
    assert not of.accepted(q, error, 5e-4, 5e-3)
    assert of.limit_margin(q, *spec.ARM_LIMITS) >= 0


def test_the_margin_is_that_of_the_nearest_limit():
    lower, upper = spec.ARM_LIMITS
    q = (lower + upper) / 2
    q[2] = upper[2] - 0.1
    assert of.limit_margin(q, lower, upper) == pytest.approx(0.1)
    q[4] = lower[4] - 0.2
    assert of.limit_margin(q, lower, upper) == pytest.approx(-0.2)
