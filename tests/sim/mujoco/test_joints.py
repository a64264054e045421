"""The second engine runs the lesson's controller with the same stamps."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.mujoco import joints as mujoco_joints

K = JOINT_NAMES.index(l04.STEPPED_JOINT)
LINKS = ["link0", "link4", "hand"]
SHORT = replace(l04.G2, steps=30)


@pytest.fixture(scope="module", params=("implicitfast", "Euler"))
def trace(request):
    return mujoco_joints.run_case(SHORT, LINKS, 0.0005, request.param)


def test_forces_have_the_times_of_the_states_and_are_bounded_law_and_net_force(trace):
    demand = SHORT.kp * (SHORT.q_target - trace.q[1:]) - SHORT.kv * trace.qd
    law = np.clip(demand, -SHORT.effort_limit, SHORT.effort_limit)
    assert trace.control_force == pytest.approx(law, abs=1e-2)
    assert trace.start_control_force[K] == SHORT.effort_limit[K]
    # At the end the control force still holds the arm against gravity.
    assert abs(trace.internal_force[-1, K]) < 5 < abs(trace.control_force[-1, K])
