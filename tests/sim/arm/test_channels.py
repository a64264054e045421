"""Channels and levels of a joint are the record and what was read back."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.spec import STEPPED_JOINT
from robo_genesis.sim.arm.channels import channels, levels, motion
from robo_genesis.sim.arm.joints import JointError


def test_channels_are_the_record_with_the_start_before_the_first_step(traces, joints):
    k, trace = joints.entry(STEPPED_JOINT), traces["G2"]
    found = channels(traces, joints, STEPPED_JOINT)
    assert [(c.name, c.head, c.unit) for c in found] == [
        ("position", "q", "rad"), ("velocity", "q̇", "rad/s"), ("control force", "force", "N·m"),
    ]  # fmt: skip
    position, velocity, force = (channel.values["G2"] for channel in found)
    assert np.array_equal(position, trace.q[:, k])
    assert np.array_equal(velocity, [trace.start_qd[k], *trace.qd[:, k]])
    assert np.array_equal(force, [trace.start_control_force[k], *trace.control_force[:, k]])


def test_levels_are_the_target_and_the_limit_read_back(traces, joints):
    target, limit = levels(traces, joints, STEPPED_JOINT, SETTLING_BAND)
    assert (target.channel, limit.channel) == ("position", "control force")
    assert target.values["G1"] == (traces["G1"].target[0, joints.entry(STEPPED_JOINT)],)
    assert (target.texts["G1"], target.band) == ("−1.7500 rad", SETTLING_BAND)
    assert limit.values["G1"] == (-87.0, 87.0)
    assert limit.texts["G1"] == "±87 N·m"


def test_units_follow_the_joint(traces, joints):
    assert [c.unit for c in channels(traces, joints, "finger_joint1")] == ["m", "m/s", "N"]


def test_an_unknown_joint_is_refused(traces, joints):
    with pytest.raises(JointError, match="Joint 'wheel' is not in this map"):
        channels(traces, joints, "wheel")


def test_the_motion_is_described_by_the_record(traces, joints):
    sentence = "`joint4` starts at −2.0000 rad and gets the target −1.7500 rad."
    assert motion(traces["G2"], joints, STEPPED_JOINT) == sentence


def test_a_target_that_changes_is_shown_one_after_the_other(traces, joints):
    k, trace = joints.entry(STEPPED_JOINT), traces["G2"]
    command = np.array(trace.target)
    command[60:, k] = -1.5
    run = {"G2": replace(trace, target=command)}
    target, _ = levels(run, joints, STEPPED_JOINT, SETTLING_BAND)
    assert target.values["G2"] == (-1.75, -1.5)
    assert target.texts["G2"] == "−1.7500 rad,\n−1.5000 rad"
    assert motion(run["G2"], joints, STEPPED_JOINT).endswith(
        "target −1.7500 rad, then −1.5000 rad."
    )
