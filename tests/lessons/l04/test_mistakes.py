"""Failures are not found where nothing is wrong; the page shows where they are."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.checks import Check
from robo_genesis.lessons.l04 import mistakes, spec

STAY = replace(spec.BASELINE, q_target=spec.BASELINE.q_start)
AT_START = replace(spec.G2, q_target=spec.G2.q_start)


@pytest.mark.engine
@pytest.mark.parametrize(
    ("mistake", "args", "says"),
    [
        # In a scene with one robot, the index that is wrong elsewhere is right.
        (mistakes.wrong_index, (spec.BASELINE,), "`joint4` moved most"),
        (mistakes.assigned_each_step, (STAY,), "rad from its target"),
        (mistakes.stale_target, (STAY,), "in 120 steps. After a complete"),
        (mistakes.gains_without_reset, ((AT_START, spec.G3),), "instead of 0.2500 rad"),
        (mistakes.past_a_limit, (spec.BASELINE, -1.0), "No exception was raised."),
        (mistakes.fingers_without_gains, (spec.BASELINE, 0.02), "ended at 0.0200 m before"),
    ],
)
def test_a_symptom_is_not_found_where_nothing_is_wrong(lab, mistake, args, says):
    """The page about mistakes requires that each symptom appears."""
    arm = mistakes.Arm(lab.scene, lab.franka, lab.joints)
    arm.reset(spec.BASELINE)
    found = mistake(arm, *args)
    assert not found.shown
    assert says in found.evidence


def test_mistakes_of_reading_are_not_found_where_nothing_is_wrong(traces):
    still, force = traces["G1"], np.full_like(traces["G1"].control_force, -22.5)
    resting = replace(still, internal_force=force, control_force=force)
    assert not mistakes.wrong_getter(resting).shown
    unobserved = mistakes.time_shift(replace(still, q=np.tile(still.q[0], (len(still.t), 1))))
    assert unobserved.check == Check("gallery_time_shift", False, unobserved.evidence)
