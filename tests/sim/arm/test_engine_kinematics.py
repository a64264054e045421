"""Questions to the engine's solver: order of the joints, settings, refusals."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim.arm import engine_kinematics as of
from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.arm.model import ModelError

POSE = {"position": np.array([0.45, 0.0, 0.35]), "quat": np.array([0.0, 1.0, 0.0, 0.0])}


class Robot:
    """A robot that keeps its question, and answers with its start."""

    def __init__(self, environments, n_dofs):
        self.scene, self.n_dofs = SimpleNamespace(n_envs=environments), n_dofs

    def get_link(self, name):
        return SimpleNamespace(name=name)

    def inverse_kinematics(self, **question):
        self.question = question
        return question["init_qpos"], np.zeros(6, np.float32)


def ask(joints, environments=0, rows=None, envs=None, n_dofs=9, **given):
    """Ask for one pose, or for `rows` equal ones; return answer and question."""
    robot, arrays = Robot(environments, n_dofs), POSE | {"q_start": Q_START} | given
    if rows is not None:
        arrays = {name: np.tile(values, (rows, 1)) for name, values in arrays.items()}
    settings = of.IkSettings(samples=1, iterations=7)
    found = of.solve_ik(robot, joints, **arrays, settings=settings, envs=envs)
    return found, robot.question


def test_every_setting_is_given_to_the_engine_and_its_order_is_that_of_the_map(joints):
    places = {
        name: getattr(joints, name)[::-1] for name in ("dofs_idx_local", "qs_idx_local")
    }
    backwards = replace(joints, names=joints.names[::-1], **places)
    found, question = ask(backwards, q_start=Q_START[::-1])
    assert question.pop("link").name == "hand"
    assert question.pop("init_qpos") == pytest.approx(Q_START)
    assert found.q == pytest.approx(Q_START[::-1])
    assert question | {"pos": None, "quat": None} == {
        "pos": None,
        "quat": None,
        "respect_joint_limit": True,
        "max_samples": 1,
        "max_solver_iters": 7,
        "damping": 0.01,
        "pos_tol": 5e-4,
        "rot_tol": 5e-3,
        "max_step_size": 0.5,
        "dofs_idx_local": list(range(7)),
        "return_error": True,
    }


@pytest.mark.parametrize(("rows", "envs"), [(4, None), (2, [3, 1])])
def test_rows_belong_to_all_environments_or_to_those_that_are_named(joints, rows, envs):
    found, question = ask(joints, 4, rows, envs)
    assert found.q.shape == (rows, 9)
    assert question.get("envs_idx") == envs


def test_a_robot_with_further_joints_is_refused(joints):
    with pytest.raises(ModelError, match="The robot has 15 DOFs, the map 9"):
        ask(joints, n_dofs=15)
