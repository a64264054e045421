"""Each failure shows its symptom on the real engine, and not where nothing is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l05 import mistakes, spec

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


def test_without_a_camera_the_wall_is_not_judged():
    found = mistakes.beyond_far(None, None)
    assert (found.shown, found.evidence) == (True, "SKIP: this run has no camera.")
