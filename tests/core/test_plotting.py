"""General figures draw what they are given; the style makes equal figures equal bytes."""

import sys

import matplotlib as mpl
import numpy as np
import pytest
from axes import legend
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.shown import svg
from robo_genesis.page import curves


@pytest.fixture
def ax():
    return Figure().subplots()


def test_frames_are_shown_as_they_are_in_a_figure_of_the_course_s_width(frames):
    drawn = plotting.stacked(frames)
    for ax, (name, picture) in zip(drawn.axes, frames.items(), strict=True):
        assert [text.get_text() for text in ax.texts] == [f"Camera frame, {name}"]
        assert (ax.get_images()[0].get_array() == picture).all()
    assert drawn.get_figwidth() == plotting.WIDTH


def test_a_schematic_draws_the_measured_links_at_both_ends(ax, traces):
    trace, parents = traces["G1"], (-1, 0, 1)
    plotting.schematic(ax, trace, parents)
    assert "not a camera frame" in ax.get_title()
    assert legend(ax) == ["before the first step", "after the last step"]
    bones = [
        trace.link_pos[when, [parents[link], link]]
        for when in (0, -1)
        for link in (1, 2)
    ]
    for line, bone in zip(ax.get_lines(), bones, strict=True):
        assert np.array_equal(line.get_xydata(), bone[:, [0, 2]])


T = np.arange(3) * 0.01


def test_equal_arrays_and_no_others_give_the_same_bytes(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib_inline.backend_inline", None)

    def draw(position):
        return svg(curves({"wrong": (T, position)}, "position [m]"))

    with mpl.rc_context():
        plotting.use_course_style()
        assert draw(T) == draw(T) != draw(T + 1e-3 * (T > 0.01))


def test_labels_are_beside_the_ends_of_lines_in_their_order_and_apart():
    ax = plotting.axes(3)[1]
    for name, end in {"b": 2.0, "a": 1.99, "top": 900.0, "c": 2.01}.items():
        ax.semilogy([0, 1], [50, end], label=name)
    ax.axvline(0.5)
    plotting.label_ends(ax, "title", "z [mm]")
    found = sorted((text.xy[1], text.get_text()) for text in ax.texts)
    assert [name for _, name in found] == ["a", "b", "c", "top"]
    heights = np.array([height for height, _ in found])
    assert (np.diff(heights) >= plotting.LABELS_APART - 1e-9).all()
    assert 0 < heights[0] < heights[-1] < 1
