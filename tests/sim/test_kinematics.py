"""Questions to the engine's solver: order of the joints, settings, refusals."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim import kinematics as of
from robo_genesis.sim.franka import JOINT_NAMES, Q_START

POSE = np.array([0.45, 0.0, 0.35]), np.array([0.0, 1.0, 0.0, 0.0])


class Robot:
    """A robot that keeps its question, and answers with its start."""

    def __init__(self, environments=0):
        self.scene = SimpleNamespace(n_envs=environments)

    def get_link(self, name):
        return SimpleNamespace(name=name)

    def inverse_kinematics(self, **question):
        self.question = question
        return question["init_qpos"], np.zeros(6, np.float32)


def ask(joints, position=POSE[0], quat=POSE[1], q_start=Q_START):
    robot = Robot()
    settings = of.IkSettings(samples=1, iterations=7)
    found = of.solve_ik(robot, joints, "hand", position, quat, q_start, JOINT_NAMES[:7], settings)
    return found, robot.question


def test_every_setting_is_given_to_the_engine(joints):
    _, question = ask(joints)
    assert question["link"].name == "hand"
    assert question["dofs_idx_local"] == list(range(7))
    assert (question["max_samples"], question["max_solver_iters"]) == (1, 7)
    assert (question["pos_tol"], question["rot_tol"]) == (5e-4, 5e-3)
    assert (question["damping"], question["max_step_size"]) == (0.01, 0.5)
    assert question["respect_joint_limit"]
    assert question["return_error"]


def test_start_and_answer_have_the_order_of_the_map(joints):
    backwards = replace(
        joints,
        names=joints.names[::-1],
        dofs_idx_local=joints.dofs_idx_local[::-1],
        qs_idx_local=joints.qs_idx_local[::-1],
    )
    found, question = ask(backwards, q_start=Q_START[::-1])
    assert question["init_qpos"] == pytest.approx(Q_START)
    assert found.q == pytest.approx(Q_START[::-1])
    assert question["dofs_idx_local"] == list(range(7))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"position": np.zeros(2)}, r"position has shape \(2,\), expected \(3,\)"),
        ({"quat": np.zeros(3)}, r"quat has shape \(3,\), expected \(4,\)"),
        ({"q_start": np.zeros(7)}, r"q_start has shape \(7,\), expected \(9,\)"),
        ({"position": np.array([0, np.nan, 0])}, "position is .*nan.*, expected finite numbers"),
    ],
)
def test_a_question_of_the_wrong_form_is_refused(joints, given, message):
    with pytest.raises(of.KinematicsError, match=message):
        ask(joints, **given)
