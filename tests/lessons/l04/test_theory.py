"""The ideal joint against another implementation, and what the models give for known runs."""

import control
import numpy as np
import pytest

from robo_genesis.lessons.l04.theory import IdealJoint, step_share

T = np.linspace(0, 1.2, 24001)


@pytest.mark.parametrize("damping", [20.0, 300.0])
def test_response_and_overshoot_are_those_of_the_transfer_function(damping):
    joint, plant = (
        IdealJoint(1.077, damping, 3500.0),
        control.tf([3500.0], [1.077, damping, 3500]),
    )
    oracle = control.step_response(plant, T).outputs
    assert joint.response(T) == pytest.approx(oracle, abs=1e-6)
    overshoot = control.step_info(plant, T=T)["Overshoot"]
    assert 100 * joint.overshoot == pytest.approx(overshoot, abs=1e-3)


def test_what_acts_on_both_runs_is_gone_from_the_share(make_trace):
    response, sag = np.array([0.0, 0.2, 0.5, 0.8, 1.0]), -0.02 * np.arange(5)
    share = step_share(make_trace(0.5 * response + sag, 0.5), make_trace(sag, 0.0), 0)
    assert share == pytest.approx(response)
