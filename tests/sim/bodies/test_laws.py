"""Laws of a body on a surface, and what may differ while a cube is on an edge."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.bodies import laws as bodies
from robo_genesis.sim.bodies.contacts import ContactCase
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

CASE = ContactCase(
    start=(0.0, 0.0, 1.0),
    duration=0.01,
    friction=0.5,
    surface_friction=0.2,
    dt=0.005,
    substeps=1,
)
LANDED = ContactCase(start=(0.0, 0.0, 0.765), duration=0.1)
AT_REST = mujoco_contacts.run_case(LANDED)
FALLEN = CASE.gravity * CASE.dt
ALL = np.ones(2, bool)


def run(velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0)) -> ContactTrace:
    """Three states of a cube that falls at 1 m/s; its motion changes in the second step [m/s]."""
    link_vel = np.zeros((3, 1, 3))
    link_vel[:, 0, 2] = -1.0 - FALLEN * np.arange(3)
    link_vel[2, 0] += velocity
    link_ang = np.zeros((3, 1, 3))
    link_ang[2, 0] = spin
    pos = np.full((3, 1, 3), 1.0)
    quat = np.tile([1.0, 0, 0, 0], (3, 1, 1))
    counts, depths = np.zeros((3, 1), np.int32), np.zeros((3, 1))
    return ContactTrace(
        np.arange(3) * CASE.dt, pos, quat, link_vel, link_ang, counts, depths
    )


@pytest.mark.parametrize(
    ("velocity", "spin", "breaches"),
    [
        ((0, 0, 0), (0, 0, 0), 0),
        ((-0.5, 0, 1.0), (0, 0, 0), 0),  # the larger coefficient, sliding
        ((-0.51, 0, 1.0), (0, 0, 0), 1),
        ((0.3, 0.4, 1.0), (0, 60, 0), 0),
        ((0, 0, -0.001), (0, 0, 0), 1),  # the surface pulls
        ((0, 0, 1.0), (0, 66, 0), 1),  # it acts outside of the cube
        ((0, 0, 0), (0, 0.1, 0), 1),
    ],
)
def test_an_impulse_of_the_surface_is_upward_in_the_cone_and_at_the_cube(
    velocity, spin, breaches
):
    trace = run(velocity, spin)
    assert len(list(bodies.impulses(trace, CASE, ALL))) == breaches
    assert list(bodies.impulses(trace, CASE, np.array([True, False]))) == []


@pytest.mark.parametrize(
    ("depth", "tilt", "breaches"),
    [(3e-5, 0.1, 0), (5e-6, 0.0, 2), (5e-5, 0.1, 2), (3e-7, 0.0, 0)],
)
def test_only_a_corner_of_a_tilted_cube_that_is_hardly_deep_may_be_missed(
    depth, tilt, breaches
):
    turned = [np.cos(tilt / 2), np.sin(tilt / 2) * 0.6, np.sin(tilt / 2) * 0.8, 0]
    quat = np.tile(turned, (3, 1, 1))
    trace = replace(run(), link_vel=np.zeros((3, 1, 3)), link_quat=quat)
    lowest = bodies.depths_before_last_step(trace, CASE)[:, 0]
    lifted = trace.link_pos + [0, 0, 1] * (lowest - depth)[:, None, None]
    trace = replace(trace, link_pos=lifted)
    assert bodies.depths_before_last_step(trace, CASE)[1, 0] == pytest.approx(
        depth, abs=1e-9
    )
    assert len(list(bodies.reported_contacts(trace, CASE))) == breaches


PUSHED = replace(LANDED, duration=0.4, settle=0.3, speed=2.0)
BALL = replace(
    LANDED, start=(0.0, 0.0, 0.865), shape="ball", spring=(1.0, 0.01), duration=0.6
)


@pytest.mark.parametrize("case", [PUSHED, BALL, replace(BALL, dt=0.02, substeps=10)])
def test_each_state_follows_from_the_state_before_it_and_no_other_does(case):
    trace = mujoco_contacts.run_case(case)
    assert list(bodies.next_states(trace, case)) == []
    altered = trace.link_vel * np.float32(1.02)
    found = bodies.next_states(replace(trace, link_vel=altered), case)
    assert {breach.code for breach in found} == {"motion"}


@pytest.mark.parametrize(
    ("array", "by", "edge", "breaches"),
    [
        ("link_quat", 1e-5, False, 1),  # in flight, the tolerances are narrower
        ("link_vel", 1e-4, False, 1),
        ("link_ang", 1e-3, False, 1),
        (
            "link_pos",
            1e-2,
            True,
            1,
        ),  # a mean velocity that is not between those at both ends
    ],
)
def test_an_altered_sample_of_a_fall_breaks_a_law(
    monkeypatch, array, by, edge, breaches
):
    case = replace(LANDED, start=(0.0, 0.0, 1.2))
    trace = mujoco_contacts.run_case(case)
    altered = np.array(getattr(trace, array))
    altered[5, 0, 2] += by
    if edge:
        monkeypatch.setattr(
            bodies, "on_edge", lambda depths, size: np.ones(len(depths), bool)
        )
        monkeypatch.setattr(bodies, "impulses", lambda *_: ())
    found = list(bodies.next_states(replace(trace, **{array: altered}), case))
    assert [breach.code for breach in found] == ["motion"] * breaches


@pytest.mark.parametrize(("turning", "faster"), [(1e-4, 1e-4), (1e-3, 0), (0, 1e-3)])
def test_a_ball_does_not_turn_and_falls_by_gravity_until_its_contact(turning, faster):
    trace = mujoco_contacts.run_case(BALL)
    spin = np.where(np.cumsum(trace.contacts)[:, None, None] > 0, turning, 0) * np.ones(
        3
    )
    altered = replace(trace, link_ang=spin, link_vel=trace.link_vel * (1 + faster))
    assert len(list(bodies.bounded(altered, BALL))) == (max(turning, faster) == 1e-3)


@pytest.mark.parametrize(
    ("shape", "turning", "codes"),
    [("cube", 0, ["motion"]), ("cube", 1e-9, []), ("ball", 0, [])],
)
def test_a_cube_in_contact_has_an_angular_velocity_of_rounding(shape, turning, codes):
    trace = replace(AT_REST, link_ang=np.full_like(AT_REST.link_ang, turning))
    found = bodies.never_still(trace, replace(LANDED, shape=shape))
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
def test_a_tilted_cube_may_report_corners_just_above_the_surface(
    tilt, about_x, reported, codes
):
    posed = lying([np.cos(tilt / 2), about_x, np.sin(tilt / 2), 0], reported)
    assert [breach.code for breach in bodies.reported_contacts(posed, LANDED)] == codes


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
    height = bodies.depths_before_last_step(posed, LANDED)[:, 0] - depth
    return replace(posed, link_pos=posed.link_pos + [0, 0, 1] * height[:, None, None])
