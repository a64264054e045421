"""The controls of a replay name what it shows, and its table has every sample."""

import json
from dataclasses import replace

import numpy as np
import pytest
from bs4 import BeautifulSoup

from robo_genesis.core.channels import Runs
from robo_genesis.lessons import find_replay
from robo_genesis.site.replay import controls, viewer
from robo_genesis.site.replay.recorded_runs import read_runs
from robo_genesis.site.replay.scenery import Camera, Scenery


@pytest.fixture(scope="module")
def joint(pristine) -> Runs:
    return read_runs(pristine, find_replay("l04"), {})


CAMERA = Camera(np.array([0.2, 0.5, 0.0]), 1.5)


def test_the_controls_name_parts_and_levels_and_have_the_script_s_data(joint):
    words = controls.opening("replay", controls.data(joint))
    html = words + controls.panel("replay-x", joint, 560)
    root = BeautifulSoup(html, "html.parser").div
    terms = ["time", "position", "velocity", "control force", "target", "force limit"]
    assert [term.get_text() for term in root.select("dt")] == terms
    target, limit = json.loads(root.select_one("input[type=radio]")["data-levels"])
    assert target == {
        "channel": "position",
        "mark": "target",
        "values": [-1.75],
        "text": "−1.7500 rad",
    }
    assert (limit["channel"], limit["values"]) == ("control force", [-87, 87])
    around = Scenery([], CAMERA, axis=True, target={"hand": np.eye(4)})
    for words in ("the axis of joint4", "joint4 at its target"):
        assert words in controls.caption(joint, around)


@pytest.mark.parametrize(("until", "speed"), [(0.6, "0.1"), (1.2, "0.25"), (6.5, "1")])
def test_a_run_ends_within_eight_seconds(joint, until, speed):
    timed = replace(joint, replay=replace(joint.replay, until=until))
    root = BeautifulSoup(controls.panel("replay-x", timed, 560), "html.parser")
    assert root.select_one("option[selected]")["value"] == speed


def test_the_viewer_is_the_package_s_without_other_hosts():
    script = viewer.viewer().decode()
    assert "gstatic.com" not in script
    assert "sourceMappingURL" not in script
    assert "Licensed under the Apache License" in script  # the notices are all there
    assert script.startswith("/* See NOTICE.txt. */")


def test_each_package_in_the_viewer_is_named_with_its_licence_beside_it(tmp_path):
    lines = list(viewer.copy_licences(tmp_path))
    assert len(lines) == len(viewer.PARTS) == len(list(tmp_path.iterdir()))
    said = {line.split()[1]: line for line in lines}
    assert " MIT, LICENSE-three.txt" in said["three"]
    assert " BSD-3-Clause, LICENSE-lit.txt" in said["lit"]
    assert "three.js authors" in (tmp_path / "LICENSE-three.txt").read_text()
