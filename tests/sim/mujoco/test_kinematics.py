"""MuJoCo's Jacobian and gravity on the bare model agree with differences and with the full one."""

import pytest

from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.mujoco import joints as mujoco_joints
from robo_genesis.sim.mujoco import kinematics as of


def test_a_load_adds_its_weight_times_the_lever():
    bare, one, two = (of.gravity_effort(Q_START, load) for load in (0.0, 1.0, 2.0))
    assert bare == pytest.approx(mujoco_joints.at_rest(Q_START)[1])
    assert two - one == pytest.approx(one - bare)
    assert (one - bare)[0] == pytest.approx(0, abs=1e-9)  # joint1 turns about the vertical
    assert (one - bare)[1] < -3
