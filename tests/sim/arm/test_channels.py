"""Channels and levels of a joint are the record and what was read back."""

from dataclasses import replace

import numpy as np

from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.spec import STEPPED_JOINT
from robo_genesis.sim.arm.channels import channels, levels, motion


def test_channels_are_the_record_with_the_start_before_the_first_step(traces, joints):
    k, trace = joints.entry(STEPPED_JOINT), traces["G2"]
    found = channels(traces, joints, STEPPED_JOINT)
    assert [(c.name, c.head, c.unit) for c in found] == [
        ("position", "q", "rad"),
        ("velocity", "q̇", "rad/s"),
        ("control force", "force", "N·m"),
    ]
    position, velocity, force = (channel.values["G2"] for channel in found)
    assert np.array_equal(position, trace.q[:, k])
    assert np.array_equal(velocity, [trace.start_qd[k], *trace.qd[:, k]])
    assert np.array_equal(
        force, [trace.start_control_force[k], *trace.control_force[:, k]]
    )
    assert [c.unit for c in channels(traces, joints, "finger_joint1")] == [
        "m",
        "m/s",
        "N",
    ]


def test_levels_are_the_targets_one_after_the_other_and_the_limit_read_back(
    traces, joints
):
    k, trace = joints.entry(STEPPED_JOINT), traces["G2"]
    command = np.array(trace.target)
    command[60:, k] = -1.5
    runs = {"G1": traces["G1"], "G2": replace(trace, target=command)}
    target, limit = levels(runs, joints, STEPPED_JOINT, SETTLING_BAND)
    assert (target.channel, limit.channel) == ("position", "control force")
    assert target.values == {"G1": (traces["G1"].target[0, k],), "G2": (-1.75, -1.5)}
    assert target.texts == {"G1": "−1.7500 rad", "G2": "−1.7500 rad,\n−1.5000 rad"}
    assert target.band == SETTLING_BAND
    assert (limit.values["G1"], limit.texts["G1"]) == ((-87.0, 87.0), "±87 N·m")
    sentence = "`joint4` starts at −2.0000 rad and gets the target −1.7500 rad"
    assert motion(runs["G1"], joints, STEPPED_JOINT) == f"{sentence}."
    assert motion(runs["G2"], joints, STEPPED_JOINT) == f"{sentence}, then −1.5000 rad."
    command[:, k] = -np.linspace(1.75, 1.5, len(command))
    every = f"{sentence}, then −1.5000 rad ({len(command)} values)."
    assert motion(replace(trace, target=command), joints, STEPPED_JOINT) == every
