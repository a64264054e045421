"""Several runs in one view have the links of all, each at its place."""

from dataclasses import replace

import numpy as np
import pytest
from falling import LINKS, falling

from robo_genesis.sim.bodies import channels as body_channels
from robo_genesis.sim.visual_shape import WORLD, Part, floor
from robo_genesis.site.replay.scenery import scenery
from robo_genesis.site.replay.side_by_side import side_by_side

PLACES = ((-0.5, 0.0), (0.5, 0.25))
SHAPE = [Part("box", (1, 2, 3), np.eye(3), np.array([[0, 1, 2]])), floor(2.0)]


@pytest.fixture(scope="module")
def runs():
    one = falling(1.0)
    other = replace(one, link_pos=one.link_pos * 2)
    return body_channels.runs({"one": one, "other": other}, LINKS, "box", "box")


def test_each_case_moves_all_links_and_keeps_its_curve(runs):
    found, parts = side_by_side(runs, SHAPE, PLACES)
    assert found.links == [f"{run}: {link}" for run in ("one", "other") for link in LINKS]
    assert [part.link for part in parts] == ["one: box", "other: box", WORLD]
    for trace in found.traces.values():
        for k, (source, (x, y)) in enumerate(zip(runs.traces.values(), PLACES, strict=True)):
            moved = trace.link_pos[:, 2 * k + 1] - source.link_pos[:, 1]
            assert moved == pytest.approx(np.tile([x, y, 0], (len(moved), 1)), abs=1e-6)
    assert found.channels == runs.channels


def test_the_view_has_neither_axis_nor_followed_link(runs):
    found, parts = side_by_side(runs, SHAPE, PLACES)
    around = scenery(parts, found, hinged=False)
    assert not around.axis
    assert around.followed is None


def test_a_run_without_a_place_is_refused(runs):
    with pytest.raises(ValueError, match="1 places given for 2 runs: one, other"):
        side_by_side(runs, SHAPE, PLACES[:1])
