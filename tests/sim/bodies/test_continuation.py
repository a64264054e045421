"""The next state of a body on a surface, and contacts of a cube that is tilted."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.sim.bodies.contacts import ContactCase
from robo_genesis.sim.bodies.continuation import NEXT, by_mujoco, level, up_and_down
from robo_genesis.sim.bodies.laws import (
    depths_before_last_step,
    never_still,
    reported_contacts,
)
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

CASE = ContactCase(start=(0.0, 0.0, 1.0), duration=0.6)
BALL = replace(CASE, start=(0.0, 0.0, 0.865), shape="ball", spring=(1.0, 0.01))
AT_REST = mujoco_contacts.run_case(replace(CASE, start=(0, 0, 0.765), duration=0.1))


def states(trace, **changed):
    begin = {name: getattr(trace, name)[:-1, 0].astype(np.float64) for name in NEXT}
    for name, value in changed.items():
        begin[name] += value
    return begin


@pytest.mark.parametrize(
    ("case", "dt", "substeps"),
    [(CASE, 0.01, 2), (CASE, 0.01, 1), (CASE, 0.02, 2), (CASE, 0.02, 1), (BALL, 0.01, 1),
     (BALL, 0.01, 10)],
)  # fmt: skip
def test_the_formula_of_a_body_that_moves_up_and_down_is_the_model_of_mujoco(case, dt, substeps):
    case = replace(case, dt=dt, substeps=substeps)
    begin = states(mujoco_contacts.run_case(case))
    assert level(begin).all()
    formula, model = up_and_down(begin, case), by_mujoco(begin, case)
    lowest = case.rest_height - begin["link_pos"][:, 2].min()
    assert lowest > 1e-4  # it touched the surface
    for array, tolerance in NEXT.items():
        assert np.abs(formula[array] - model[array]).max() < tolerance / 4


@pytest.mark.parametrize(
    "changed",
    [
        {"link_quat": [0, 1e-3, 0, 0]},
        {"link_vel": [1e-3, 0, 0]},
        {"link_ang": [0, 0, 0.1]},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_body_that_turns_or_moves_sideways_is_not_level(changed):
    assert level(states(AT_REST)).all()
    assert not level(states(AT_REST, **changed)).any()


@pytest.mark.parametrize(
    ("shape", "turning", "codes"),
    [("cube", 0, ["motion"]), ("cube", 1e-9, []), ("ball", 0, [])],
)
def test_a_cube_in_contact_has_an_angular_velocity_of_rounding(shape, turning, codes):
    trace = replace(AT_REST, link_ang=np.full_like(AT_REST.link_ang, turning))
    found = never_still(trace, replace(CASE, shape=shape))
    assert [breach.code for breach in found] == codes


@pytest.mark.parametrize(
    ("tilt", "about_x", "reported", "codes"),
    [
        (0.0, 0, 4, []),
        (0.0, 0, 3, ["contact"]),
        (0.005, 0, 2, []),
        (0.005, 0, 4, []),  # Genesis turns the cube by up to 0.01 rad to find contacts
        (0.05, 0, 2, []),
        (0.05, 0, 3, []),  # on an edge: its ends, and a point between them
        (0.05, 0, 4, ["contact"]),
        (0.05, 0, 1, ["contact"]),
        (0.3, 0.0025, 2, []),  # on one corner
        (0.3, 0.0025, 3, ["contact"]),
    ],
)
def test_a_tilted_cube_may_report_corners_just_above_the_surface(tilt, about_x, reported, codes):
    posed = lying([np.cos(tilt / 2), about_x, np.sin(tilt / 2), 0], reported)
    assert [breach.code for breach in reported_contacts(posed, CASE)] == codes


def lying(quat, reported):
    """Return states of a cube that is turned and has its lowest corner 0.1 mm deep."""
    states, depth = len(AT_REST.t), 1e-4
    posed = replace(
        AT_REST,
        link_pos=np.zeros((states, 1, 3)),
        link_quat=np.tile(quat / np.linalg.norm(quat), (states, 1, 1)),
        link_vel=np.zeros((states, 1, 3)),
        link_ang=np.zeros((states, 1, 3)),
        penetration=np.where(AT_REST.t[:, None] > 0, depth, 0),
        contacts=np.where(AT_REST.t[:, None] > 0, reported, 0),
    )
    height = depths_before_last_step(posed, CASE)[:, 0] - depth
    return replace(posed, link_pos=posed.link_pos + [0, 0, 1] * height[:, None, None])
