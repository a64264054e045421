"""Laws of free bodies on runs of MuJoCo, which has the same contacts."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import make_drop
from lessons.changed_runs import shift, with_fields

from robo_genesis.lessons.l02 import spec
from robo_genesis.sim.bodies import laws
from robo_genesis.sim.bodies.contacts import ContactCase
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

LANDED = ContactCase(start=(0.0, 0.0, 0.765), duration=0.1)
PUSHED = replace(LANDED, duration=0.4, settle=0.3, speed=2.0)
BALL = replace(
    LANDED, start=(0.0, 0.0, 0.865), shape="ball", spring=(1.0, 0.01), duration=0.6
)


@pytest.mark.parametrize("case", [PUSHED, BALL, replace(BALL, dt=0.02, substeps=10)])
def test_runs_keep_their_laws_and_no_others_do(case):
    trace = mujoco_contacts.run_case(case)
    assert not [*laws.reported_depth(trace, case), *laws.repeated_steps(trace, case)]
    faster = replace(trace, link_vel=trace.link_vel * np.float32(1.02))
    assert [*laws.repeated_steps(faster, case)]
    earlier = replace(trace, penetration=np.roll(trace.penetration, -1, axis=0))
    assert [*laws.reported_depth(earlier, case)]


@pytest.mark.parametrize(
    ("depth", "times", "reported", "broken"),
    [
        (3e-5, 1, 0, False),
        (3e-5, 1, 1e-5, False),
        (3e-5, 3, 0, True),
        (5e-5, 1, 0, True),
        (3e-5, 1, 5e-5, True),
    ],
)
def test_a_corner_that_is_hardly_deep_may_be_missed_now_and_then(
    depth, times, reported, broken
):
    trace = mujoco_contacts.run_case(LANDED)
    turned = np.float32([np.cos(0.1), 0, np.sin(0.1), 0])
    still = np.zeros_like(trace.link_vel)
    depths = np.full_like(trace.penetration, depth)
    depths[1 : 1 + times] = reported
    tilted = replace(
        trace,
        link_quat=np.broadcast_to(turned, trace.link_quat.shape),
        link_vel=still,
        link_ang=still,
        penetration=depths,
    )
    lowest = laws.depth_before_last_step(tilted, LANDED)[:, None, None]
    lifted = replace(tilted, link_pos=tilted.link_pos + [0, 0, 1] * (lowest - depth))
    assert bool([*laws.reported_depth(lifted, LANDED)]) is broken


@pytest.mark.parametrize(
    ("array", "by"), [("link_pos", 1e-5), ("link_vel", 2e-4), ("link_quat", 1e-6)]
)
def test_a_fall_has_the_place_the_velocity_and_the_orientation_of_free_fall(array, by):
    trace = make_drop(spec.BASELINE)
    assert not [*laws.falling(trace, spec.BASELINE)]
    altered = with_fields(trace, {array: shift((5, 0, 2), by)})
    assert [*laws.falling(altered, spec.BASELINE)]
