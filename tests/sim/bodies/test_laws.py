"""What may differ from the second engine while a cube is on an edge, and what may not."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.bodies import laws as bodies
from robo_genesis.sim.bodies.contacts import ContactCase

CASE = ContactCase(
    start=(0.0, 0.0, 1.0), duration=0.01, friction=0.5, surface_friction=0.2, dt=0.005, substeps=1
)
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
    return ContactTrace(np.arange(3) * CASE.dt, pos, quat, link_vel, link_ang, counts, depths)


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
def test_an_impulse_of_the_surface_is_upward_in_the_friction_cone_and_at_the_cube(
    velocity, spin, breaches
):
    trace = run(velocity, spin)
    assert len(list(bodies.impulses(trace, CASE, ALL))) == breaches
    assert list(bodies.impulses(trace, CASE, np.array([True, False]))) == []


@pytest.mark.parametrize(
    ("depth", "tilt", "breaches"), [(5e-6, 0.1, 0), (5e-6, 0.0, 2), (2e-5, 0.1, 2), (3e-7, 0.0, 0)]
)
def test_only_a_corner_of_a_tilted_cube_that_is_hardly_deep_may_be_missed(depth, tilt, breaches):
    turned = [np.cos(tilt / 2), np.sin(tilt / 2) * 0.6, np.sin(tilt / 2) * 0.8, 0]
    quat = np.tile(turned, (3, 1, 1))
    trace = replace(run(), link_vel=np.zeros((3, 1, 3)), link_quat=quat)
    lowest = bodies.depths_before_last_step(trace, CASE)[:, 0]
    lifted = trace.link_pos + [0, 0, 1] * (lowest - depth)[:, None, None]
    trace = replace(trace, link_pos=lifted)
    assert bodies.depths_before_last_step(trace, CASE)[1, 0] == pytest.approx(depth, abs=1e-9)
    assert len(list(bodies.reported_contacts(trace, CASE))) == breaches
