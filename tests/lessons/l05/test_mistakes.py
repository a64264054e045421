"""Each failure shows its symptom on the real engine, and not where nothing is wrong."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.lessons.l05 import mistakes, spec
from robo_genesis.sim.camera.geometry import intrinsics, other_axes

CASE = spec.BASELINE
BEYOND = replace(CASE, position=spec.BEYOND_REACH)


@pytest.mark.engine
@pytest.mark.parametrize(
    ("mistake", "args", "shown", "says"),
    [
        (mistakes.swapped_quaternion, (CASE,), True, "vertical component +1.000"),
        (mistakes.swapped_quaternion, (replace(CASE, quat=np.roll(CASE.quat, 1)),), False, "-1.0"),
        (mistakes.other_frame, (CASE, np.array([0.2, 0.1, 0.0])), True, "223."),
        (mistakes.other_frame, (CASE, np.zeros(3)), False, "accepted"),
        (mistakes.unaccepted_answer, (BEYOND,), True, "The answer is refused"),
        (mistakes.unaccepted_answer, (CASE,), False, "The answer is accepted"),
        (mistakes.degrees, (CASE,), True, "`CaseError`: q_target[joint2]"),
    ],
)
def test_a_symptom_is_found_where_it_appears(lab, mistake, args, shown, says):
    here = (lab.franka, lab.joints)
    if mistake in (mistakes.unaccepted_answer, mistakes.degrees):
        here = (lab.scene, *here)
    found = mistake(*here, *args)
    assert found.shown == shown
    assert says in found.evidence


POINT = np.array([0.3, 0.0, 0.0])


def camera(*res):
    """Return what stands for a camera that looks down, at first from the height of 1 m."""
    pose = np.eye(4) + np.outer([0, 0, 1, 0], [0, 0, 0, 1])
    fixed = {"intrinsics": intrinsics(42.0, res), "extrinsics": np.linalg.inv(other_axes(pose))}
    made = SimpleNamespace(res=res, far=20.0, transform=pose, **fixed)
    made.set_pose = lambda height: pose.put(11, height)
    return made


@pytest.mark.parametrize(
    ("mistake", "args", "shown"),
    [
        (mistakes.rows_first, (camera(640, 480), camera(480, 640), POINT), True),
        (mistakes.rows_first, (camera(640, 480), camera(640, 480), POINT), False),
        (mistakes.stale_extrinsics, (camera(640, 480), {"height": 3.0}, POINT), True),
        (mistakes.stale_extrinsics, (camera(640, 480), {"height": 1.0}, POINT), False),
        (mistakes.beyond_far, (np.full((480, 640), 19.9999), camera(640, 480)), False),
        (mistakes.beyond_far, (None, None), True),
    ],
)
def test_a_mistake_of_a_camera_is_found_where_it_was_made(mistake, args, shown):
    assert mistake(*args).shown == shown
