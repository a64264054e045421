"""The controls of a replay name what it shows, and its table has every sample."""

import base64
import gzip
import html
import json
import re
from dataclasses import replace

import numpy as np
import pygltflib as gltf
import pytest
from bs4 import BeautifulSoup
from falling import LINKS, falling

from robo_genesis.core.channels import Runs
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.lessons import LESSONS
from robo_genesis.pipeline.html.checks import SERVICES
from robo_genesis.sim.bodies import channels as body_channels
from robo_genesis.site.replay import controls, viewer
from robo_genesis.site.replay import directive as sphinx_replay
from robo_genesis.site.replay.scenery import Camera, Scenery


@pytest.fixture(scope="module")
def joint(pristine) -> Runs:
    return read_runs(pristine, LESSONS["l04"].compared)


@pytest.fixture(scope="module")
def box() -> Runs:
    traces = {"high": falling(2.0, dt=0.0025), "low": falling(1.0, dt=0.0025)}
    return body_channels.runs(traces, LINKS, "box", "box")


CAMERA = Camera(np.array([0.2, 0.5, 0.0]), 1.5)
AROUND = {
    "robot": Scenery([], CAMERA, axis=True, target={"hand": np.eye(4)}),
    "box": Scenery([], CAMERA, followed=0),
}
FILES = controls.Files("replay/a.js", "replay/viewer.js")


def parsed(runs: Runs) -> BeautifulSoup:
    camera = AROUND[runs.view.thing].camera
    text = controls.opening("replay-x", runs, camera, FILES) + controls.panel("replay-x", runs, 560)
    return BeautifulSoup(text, "html.parser").div


SHOWN = {
    "joint": {
        "legend": "Run of joint4",
        "weight": "Play loads the robot in 3D: 560 kB.",
        "picture": "The robot at the start of G1, drawn from the recorded poses.",
        "caption": "Recorded poses of the robot. Yellow rod: the axis of joint4. "
        "Dark and translucent: joint4 at its target, other joints at rest.",
        "alt": "The robot in 3D, in the posture of the sample that is shown. joint4 moves.",
        "channels": [("position", "rad", 4), ("velocity", "rad/s", 4), ("control force", "N·m", 2)],
        "time digits": "2",
        "last sample": "120",
        "readout": ["time", "position", "velocity", "control force", "target", "force limit"],
        "runs": {"G1": "case-g1", "G2": "case-g2", "G3": "case-g3"},
    },
    "box": {
        "legend": "Run of the box",
        "weight": "Play loads the box in 3D: 560 kB.",
        "picture": "The box at the start of high, drawn from the recorded poses.",
        "caption": "Recorded poses of the box. The view follows the box horizontally.",
        "alt": "The box in 3D, where it is at the sample that is shown.",
        "channels": [("height", "m", 4), ("vertical velocity", "m/s", 4)],
        "time digits": "4",
        "last sample": "30",
        "readout": ["time", "height", "vertical velocity"],
        "runs": {"high": "case-g1", "low": "case-g2"},
    },
}  # fmt: skip


HEADS = {"joint": ["q [rad]", "q̇ [rad/s]", "force [N·m]"], "box": ["z [m]", "ż [m/s]"]}


@pytest.mark.parametrize("kind", HEADS)
def test_the_table_has_every_sample_of_each_channel(request, kind):
    runs = request.getfixturevalue(kind)
    lines = [line.strip("| ").split(" | ") for line in controls.samples(runs).splitlines()]
    assert lines[0] == [
        "t [s]",
        *(f"{case} {head}" for case in runs.traces for head in HEADS[kind]),
    ]
    numbers = np.array([[float(c.replace("−", "-")) for c in row] for row in lines[2:]])
    recorded = [channel.values[case] for case in runs.traces for channel in runs.channels]
    assert numbers == pytest.approx(np.column_stack([runs.t, *recorded]), abs=6e-5)


@pytest.mark.parametrize("kind", SHOWN)
def test_the_controls_name_their_parts_and_have_the_script_s_data(request, kind):
    runs = request.getfixturevalue(kind)
    root = parsed(runs)
    slider = root.select_one("input[type=range]")
    assert {
        "legend": root.legend.get_text(),
        "weight": root.select_one("[role=status]").get_text(),
        "picture": controls.alt(runs),
        "caption": controls.caption(runs, AROUND[runs.view.thing]),
        "alt": root["data-alt"],
        "channels": [
            (c["name"], c["unit"], c["digits"]) for c in json.loads(root["data-channels"])
        ],
        "time digits": root["data-time-digits"],
        "last sample": slider["max"],
        "readout": [term.get_text() for term in root.select("dt")],
        "runs": {one["value"]: one["data-mark"] for one in root.select("input[type=radio]")},
    } == SHOWN[kind]
    assert root["class"] == ["replay"]
    assert (root["data-orbit"], root["data-target"]) == (CAMERA.orbit, CAMERA.target)
    assert (root["data-model"], root["data-viewer"]) == (FILES.model, FILES.viewer)
    assert root.select_one(f"label[for={slider['id']}]").get_text() == "Time"
    assert len(root.select(".plots > .plot")) == len(SHOWN[kind]["channels"])


def test_levels_are_given_to_the_script_and_explained(joint):
    root = parsed(joint)
    target, limit = json.loads(root.select_one("input[type=radio]")["data-levels"])
    assert target == {
        "channel": "position", "mark": "target", "values": [-1.75], "text": "−1.7500 rad",
    }  # fmt: skip
    assert (limit["channel"], limit["values"]) == ("control force", [-87, 87])
    legend = root.select_one(".legend").get_text()
    assert "Dotted: the target. Short dashes, at the edges of the control force" in legend


def test_a_joint_s_motion_ends_with_its_quality(joint, traces):
    hand = traces["G2"].link_pos[:, 2]
    far = 100 * np.linalg.norm(hand - hand[0], axis=1).max()
    assert re.fullmatch(
        r"\*\*G2\*\*: `joint4` starts at −2\.0000 rad and gets the target −1\.7500 rad\. "
        rf"The link `hand` moves farthest, by up to {far:.1f} cm\. "
        r"Rise time [\d.]+ s, overshoot [\d.]+ rad, final error [\d.]+ rad; "
        r"at the force limit: \d+ samples?\.",
        joint.moves["G2"],
    )


def test_words_are_escaped(joint):
    runs = replace(joint, subject='a"<b')
    text = controls.opening("x", runs, CAMERA, FILES) + controls.panel("x", runs, 560)
    assert 'a"<b' not in text
    assert html.unescape(re.search('data-subject="([^"]*)"', text)[1]) == 'a"<b'


def test_the_viewer_is_the_package_s_without_other_hosts():
    script = viewer.viewer().decode()
    assert SERVICES.search(script) is None
    assert "sourceMappingURL" not in script
    assert "Licensed under the Apache License" in script  # the notices are all there
    assert script.startswith("/* See NOTICE.txt. */")


def test_a_model_is_written_twice_and_weighed(tmp_path):
    weight = sphinx_replay.write_model(tmp_path / "replay", "replay-x", b"glTF\0model")
    script = (tmp_path / "replay" / "replay-x.js").read_bytes()
    assert weight == len(gzip.compress(script))
    assert (tmp_path / "replay" / "replay-x.glb").read_bytes() == b"glTF\0model"
    packed = re.search(rb'\["replay-x"\] = "(.*)";', script)
    assert packed is not None
    assert base64.b64decode(packed[1]) == b"glTF\0model"


def test_each_package_in_the_viewer_is_named_with_its_licence_beside_it(tmp_path):
    lines = list(viewer.copy_licences(tmp_path))
    assert len(lines) == len(viewer.PARTS) == len(list(tmp_path.iterdir()))
    said = {line.split()[1]: line for line in lines}
    assert " MIT, LICENSE-three.txt" in said["three"]
    assert " BSD-3-Clause, LICENSE-lit.txt" in said["lit"]
    assert "three.js authors" in (tmp_path / "LICENSE-three.txt").read_text()


def test_the_notice_says_whose_each_model_is(tmp_path):
    for name, credit in (("replay-arm", "© Somebody, Apache-2.0"), ("replay-box", None)):
        asset = gltf.Asset(version="2.0", copyright=credit)
        (tmp_path / f"{name}.glb").write_bytes(b"".join(gltf.GLTF2(asset=asset).save_to_bytes()))
    assert list(viewer.model_credits(tmp_path)) == [
        "The model replay-arm.glb, and the same in replay-arm.js: © Somebody, Apache-2.0.\n"
    ]
