"""Runs of a joint as channels and levels, and what a replay makes of them."""

import html
import json
import re

import numpy as np
import pytest
from bs4 import BeautifulSoup

from robo_genesis.core.channels import Runs
from robo_genesis.evidence.bundle import Metric
from robo_genesis.lessons.l04.metrics import SETTLING_BAND, measure, metric_records
from robo_genesis.lessons.l04.spec import STEPPED_JOINT
from robo_genesis.sim import joint_channels
from robo_genesis.sim.joints import JointError
from robo_genesis.site.replay import controls as replay

CASES = ("G1", "G2", "G3")
LINKS = ("link0", "link4", "hand")  # of the synthetic traces


@pytest.fixture(scope="module")
def metrics(traces, joints):
    found = measure(traces, CASES, joints.entry(STEPPED_JOINT))
    return {
        case: {name: Metric.model_validate(record) for name, record in group.items()}
        for case, group in metric_records(found, {}).items()
    }


@pytest.fixture(scope="module")
def runs(traces, joints, metrics) -> Runs:
    three = {case: traces[case] for case in CASES}
    return joint_channels.runs(three, LINKS, joints, STEPPED_JOINT, metrics, SETTLING_BAND)


@pytest.fixture(scope="module")
def controls(runs) -> BeautifulSoup:
    text = replay.markup("replay-x", runs, "replay/a.js", "replay/viewer.js", 560)
    return BeautifulSoup(text, "html.parser")


def test_channels_are_the_record_with_the_start_before_the_first_step(runs, traces, joints):
    k, trace = joints.entry(STEPPED_JOINT), traces["G2"]
    position, velocity, force = runs.channels
    assert [(c.name, c.head, c.unit) for c in runs.channels] == [
        ("position", "q", "rad"), ("velocity", "q̇", "rad/s"), ("control force", "force", "N·m"),
    ]  # fmt: skip
    assert np.array_equal(position.values["G2"], trace.q[:, k])
    assert np.array_equal(velocity.values["G2"][1:], trace.qd[:, k])
    assert velocity.values["G2"][0] == trace.start_qd[k]
    assert np.array_equal(force.values["G2"][1:], trace.control_force[:, k])
    assert force.values["G2"][0] == trace.start_control_force[k]


def test_levels_are_the_target_and_the_limit_read_back(runs, traces, joints):
    k, trace = joints.entry(STEPPED_JOINT), traces["G1"]
    target, limit = runs.levels
    assert target.values["G1"] == (trace.target[0, k],)
    assert (target.said["G1"], target.band) == ("−1.7500 rad", SETTLING_BAND)
    assert limit.values["G1"] == (-87.0, 87.0)
    assert limit.said["G1"] == "±87 N·m"
    assert [runs.levels_of(c) for c in runs.channels] == [[target], [], [limit]]


def test_units_follow_the_joint(traces, joints):
    finger = joint_channels.channels({"G1": traces["G1"]}, joints, "finger_joint1")
    assert [channel.unit for channel in finger] == ["m", "m/s", "N"]


def test_an_unknown_joint_is_refused(traces, joints, metrics):
    with pytest.raises(JointError, match="Joint 'wheel' is not in this map"):
        joint_channels.runs({"G1": traces["G1"]}, LINKS, joints, "wheel", metrics, SETTLING_BAND)


def test_the_table_holds_every_sample_and_starts_before_the_first_step(runs, traces, joints):
    lines = replay.samples(runs).splitlines()
    cells = [[c.strip() for c in line.strip("|").split("|")] for line in (lines[0], *lines[2:])]
    k, trace = joints.entry(STEPPED_JOINT), traces["G1"]
    assert cells[0][:4] == ["t [s]", "G1 q [rad]", "G1 q̇ [rad/s]", "G1 force [N·m]"]
    assert len(cells) == 122
    numbers = np.array([[float(c.replace("−", "-")) for c in row] for row in cells[1:]])
    assert numbers[0, :4] == pytest.approx(
        [0, trace.q[0, k], trace.start_qd[k], trace.start_control_force[k]], abs=6e-5
    )
    assert numbers[:, 1] == pytest.approx(trace.q[:, k], abs=6e-5)
    assert numbers[1:, 9] == pytest.approx(traces["G3"].control_force[:, k], abs=6e-5)


def test_what_moves_is_said_from_the_record(runs, traces):
    assert runs.moves["G2"].startswith("**G2**: `joint4` starts at −2.0000 rad")
    assert "gets the target −1.7500 rad" in runs.moves["G2"]
    far = 100 * (traces["G2"].link_pos[:, 2, 0]).max()
    assert f"The link `hand` moves farthest, by up to {far:.1f} cm." in runs.moves["G2"]


def test_the_controls_name_their_parts(controls):
    assert controls.div["class"] == ["replay"]
    assert controls.div.has_attr("hidden")
    slider = controls.select_one("input[type=range]")
    assert slider["max"] == "120"
    assert controls.select_one(f"label[for={slider['id']}]").get_text() == "Time"
    assert len(controls.select("input[type=radio]")) == len(CASES)
    assert controls.legend.get_text() == "Run of joint4"
    assert controls.select_one(".show").get_text() == "Show the robot in 3D"
    assert len(controls.select(".plots > .plot")) == 3


def test_the_script_is_told_of_channels_and_levels(controls, traces, joints):
    channels = json.loads(controls.div["data-channels"])
    assert [(c["name"], c["unit"], c["digits"]) for c in channels] == [
        ("position", "rad", 4), ("velocity", "rad/s", 4), ("control force", "N·m", 2),
    ]  # fmt: skip
    assert controls.div["data-time-digits"] == "2"
    (first, *_) = controls.select("input[type=radio]")
    target, limit = json.loads(first["data-levels"])
    assert target == {
        "channel": "position", "mark": "target", "values": [-1.75], "said": "−1.7500 rad",
    }  # fmt: skip
    assert (limit["channel"], limit["values"]) == ("control force", [-87, 87])
    assert first["data-mark"] == "case-g1"


def test_the_readout_lists_time_channels_and_levels(controls):
    assert [term.get_text() for term in controls.select("dt")] == [
        "time", "position", "velocity", "control force", "target", "force limit",
    ]  # fmt: skip
    legend = controls.select_one(".legend").get_text()
    assert "Dotted: the target. Short dashes, at the edges of the control force" in legend


def test_words_are_escaped(runs):
    fields = {name: getattr(runs, name) for name in runs.__dataclass_fields__}
    text = replay.markup("x", Runs(**fields | {"subject": 'a"<b'}), "a.js", "b.js", 1)
    assert 'a"<b' not in text
    assert html.unescape(re.search('data-subject="([^"]*)"', text)[1]) == 'a"<b'
