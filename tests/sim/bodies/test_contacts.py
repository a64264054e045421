"""Cases of bodies on a surface: what follows from them, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.sim.bodies import soft_contact
from robo_genesis.sim.bodies.contacts import ContactCase, shared_case
from robo_genesis.sim.mujoco import contacts as mujoco_contacts
from robo_genesis.sim.session import CaseError

CASE = ContactCase(start=(0.0, 0.0, 1.0), duration=1.5)


def test_a_case_knows_its_step_mass_and_place():
    ball = replace(CASE, shape="ball")
    assert (CASE.h, CASE.steps, CASE.rest_height) == pytest.approx((0.005, 150, 0.765))
    assert (CASE.mass, CASE.inertia) == pytest.approx((0.256, 0.256 * 0.08**2 / 6))
    assert ball.mass == pytest.approx(500 * 4 / 3 * np.pi * 0.04**3)
    assert ball.inertia == pytest.approx(0.4 * ball.mass * 0.04**2)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"dt": 0.4}, r"duration is 1\.5 s, no whole number .* 0\.4 s"),
        ({"settle": 0.005}, r"settle is 0\.005 s"),
    ],
)
def test_a_case_that_cannot_be_run_is_refused(changes, message):
    with pytest.raises(CaseError, match=message):
        replace(CASE, **changes)


def test_cases_of_one_scene_share_what_a_scene_has_once():
    assert shared_case({"a": CASE, "b": replace(CASE, friction=0.1)}) is CASE
    with pytest.raises(CaseError, match=r"b asks for surface_friction=0\.3, .* 0\.8"):
        shared_case({"a": CASE, "b": replace(CASE, surface_friction=0.3)})


@pytest.mark.parametrize(
    ("h", "asked", "in_force"),
    [
        (0.02, None, 0.04),
        (0.001, None, 0.01),
        (0.0001, 0.002, 0.002),
        (0.005, 0.002, 0.01),
    ],
)
def test_the_shortest_time_constant_is_two_steps(h, asked, in_force):
    case = replace(CASE, dt=h, substeps=1, duration=h, time_constant=asked)
    assert soft_contact.time_constant(h, asked) == in_force
    assert mujoco_contacts.load(case).geom_solref[0].tolist() == [in_force, 1]
    own = mujoco_contacts.load(case, own_defaults=True)
    assert own.geom_solref[0].tolist() == [0.02, 1]
