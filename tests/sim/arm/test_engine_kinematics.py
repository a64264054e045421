"""Questions to the engine's solver: order of the joints, settings, refusals."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim.arm import engine_kinematics as of
from robo_genesis.sim.arm.franka import JOINT_NAMES, Q_START

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


def ask_rows(joints, rows, envs=None):
    robot = Robot(environments=4)
    tiled = (np.tile(values, (rows, 1)) for values in (*POSE, Q_START))
    return of.solve_ik(
        robot, joints, "hand", *tiled, JOINT_NAMES[:7], of.IkSettings(), envs
    ), robot.question


def test_rows_belong_to_all_environments_or_to_those_that_are_named(joints):
    found, question = ask_rows(joints, 4)
    assert found.q.shape == (4, 9)
    assert "envs_idx" not in question
    found, question = ask_rows(joints, 2, [3, 1])
    assert found.q.shape == (2, 9)
    assert question["envs_idx"] == [3, 1]


@pytest.mark.parametrize(("rows", "envs"), [(3, None), (1, [1, 3]), (4, [1, 3])])
def test_rows_that_the_engine_would_fit_to_environments_are_refused(joints, rows, envs):
    with pytest.raises(of.KinematicsError, match="position has shape"):
        ask_rows(joints, rows, envs)


def test_a_question_without_rows_is_refused_with_environments(joints):
    with pytest.raises(of.KinematicsError, match=r"expected \(4, 3\)"):
        of.solve_ik(
            Robot(environments=4), joints, "hand", *POSE, Q_START, JOINT_NAMES[:7], of.IkSettings()
        )
