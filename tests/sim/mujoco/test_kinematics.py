"""MuJoCo's mass matrix and gravity of the bare model are those of the full one, and with a load."""

import mujoco
import numpy as np
import pytest

from robo_genesis.lessons.l04 import spec
from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.mujoco import joints as mujoco_joints
from robo_genesis.sim.mujoco import kinematics as of


def test_gravity_inertia_and_damping_have_no_term_of_the_integrator():
    model = mujoco_joints.load(spec.G3, 0.005, "Euler")
    data, mass = mujoco.MjData(model), np.zeros((9, 9))
    data.qpos[:] = Q_START
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    expected = (mass.diagonal(), data.qfrc_bias, np.ones(9))
    assert np.array(of.at_rest(Q_START)) == pytest.approx(np.array(expected))


def test_a_load_adds_its_weight_times_the_lever():
    bare, one, two = (of.gravity_effort(Q_START, load) for load in (0.0, 1.0, 2.0))
    assert two - one == pytest.approx(one - bare)
    assert (one - bare)[0] == pytest.approx(
        0, abs=1e-9
    )  # joint1 turns about the vertical
    assert (one - bare)[1] < -3
