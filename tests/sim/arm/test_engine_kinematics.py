"""The question to the engine's solver: order of the joints and settings."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim.arm import engine_kinematics as of
from robo_genesis.sim.arm.franka import Q_START

POSE = {"position": np.array([0.45, 0.0, 0.35]), "quat": np.array([0.0, 1.0, 0.0, 0.0])}


class Robot:
    """A robot that keeps its question, and answers with its start."""

    n_dofs = 9

    def get_link(self, name):
        return SimpleNamespace(name=name)

    def inverse_kinematics(self, **question):
        self.question = question
        return question["init_qpos"], np.zeros(6, np.float32)


def test_every_setting_is_given_to_the_engine_and_its_order_is_that_of_the_map(joints):
    places = {
        name: getattr(joints, name)[::-1] for name in ("dofs_idx_local", "qs_idx_local")
    }
    backwards = replace(joints, names=joints.names[::-1], **places)
    robot, settings = Robot(), of.IkSettings(samples=1, iterations=7)
    found = of.solve_ik(
        robot, backwards, **POSE, q_start=Q_START[::-1], settings=settings
    )
    question = robot.question
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
