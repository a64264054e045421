"""Runs of free bodies as channels, and what a replay makes of them."""

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from bs4 import BeautifulSoup
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.channels import Runs
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.declaration import Moving
from robo_genesis.sim import body_channels
from robo_genesis.site.replay import controls as replay

BOX = Moving(("high", "low"), link="box", thing="box")
G = 10.0


def falling(height: float, steps: int = 30, dt: float = 0.01, drift: float = 0.0) -> BodyTrace:
    """A box that falls from a height [m] and drifts along x [m/s], and a link that stays."""
    t = np.arange(steps + 1) * dt
    pos, vel = np.zeros((2, steps + 1, 2, 3), np.float32)
    pos[:, 1, 2], vel[:, 1, 2] = height - G * t**2 / 2, -G * t
    pos[:, 1, 0], vel[:, 1, 0] = drift * t, drift
    quat = np.tile(np.float32([1, 0, 0, 0]), (steps + 1, 2, 1))
    return BodyTrace(t=t, link_pos=pos, link_quat=quat, link_vel=vel, link_ang=np.zeros_like(pos))


@pytest.fixture
def make() -> Callable[..., Runs]:
    def runs(moving: Moving = BOX, **traces: BodyTrace) -> Runs:
        given = traces or {"high": falling(2.0), "low": falling(1.0)}
        return body_channels.runs(given, ("stand", "box"), moving.link, moving.thing, moving.axes)

    return runs


def test_channels_are_height_and_vertical_velocity_of_the_record(make):
    runs = make()
    height, velocity = runs.channels
    assert [(c.name, c.head, c.unit) for c in runs.channels] == [
        ("height", "z", "m"), ("vertical velocity", "ż", "m/s"),
    ]  # fmt: skip
    for case, trace in runs.traces.items():
        assert np.array_equal(height.values[case], trace.link_pos[:, 1, 2])
        assert np.array_equal(velocity.values[case], trace.link_vel[:, 1, 2])
    assert list(runs.levels) == []
    assert (runs.subject, runs.view.credit) == ("the box", None)


def test_each_axis_brings_two_channels(make):
    moving = Moving(("a",), link="box", thing="cube", axes=("x", "z"))
    runs = make(moving, a=falling(2.0, drift=0.5))
    assert [channel.head for channel in runs.channels] == ["x", "ẋ", "z", "ż"]
    assert runs.channels[1].values["a"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (
            Moving(("high",), link="ball", thing="ball"),
            "'ball' cannot be followed. Available: stand, box",
        ),
        (
            replace(BOX, axes=("up",)),
            "'up' cannot be followed. Available: x, y, z",
        ),
    ],
)
def test_what_the_record_does_not_have_is_not_followed(make, wrong, message):
    with pytest.raises(ValueError, match=message):
        make(wrong)


@pytest.mark.parametrize("other", [falling(1.0, dt=0.02), falling(1.0, steps=20)])
def test_runs_of_other_times_are_not_played_together(make, other):
    with pytest.raises(ValueError, match=r"high 30 × 0\.01 s, low .* take one grid"):
        make(high=falling(2.0), low=other)


def test_the_table_has_the_channels_of_each_case(make):
    runs = make()
    lines = [line.strip("| ").split(" | ") for line in replay.samples(runs).splitlines()]
    assert lines[0] == [
        "t [s]", "high z [m]", "high ż [m/s]", "low z [m]", "low ż [m/s]",
    ]  # fmt: skip
    numbers = np.array([[float(c.replace("−", "-")) for c in row] for row in lines[2:]])
    assert numbers.shape == (31, 5)
    assert numbers[:, 0] == pytest.approx(runs.t)
    assert numbers[:, 3] == pytest.approx(runs.traces["low"].link_pos[:, 1, 2], abs=6e-5)
    assert numbers[:, 4] == pytest.approx(runs.traces["low"].link_vel[:, 1, 2], abs=6e-5)


def test_a_fall_is_said_from_the_record(make):
    drop = G * 0.3**2 / 2
    assert make().moves["high"] == (
        f"**high**: the box starts at a height of 2.0000 m and ends at a height of "
        f"{2 - drop:.4f} m: it fell by {drop:.4f} m, fastest at 0.30 s with −{G * 0.3:.4f} m/s. "
        f"The link `box` moves farthest, by up to {100 * drop:.1f} cm."
    )


def test_a_slide_is_said_along_its_own_axis(make):
    moving = Moving(("a",), link="box", thing="cube", axes=("x",))
    said = make(moving, a=falling(1.0, drift=-0.5)).moves["a"]
    assert "starts at x = 0.0000 m and ends at x = −0.1500 m: it moved back by 0.1500 m" in said


def test_what_stays_is_said_to_stay(make):
    still = make(Moving(("a",), link="stand", thing="stand"), a=falling(1.0))
    assert "ends at a height of 0.0000 m, at rest all the time." in still.moves["a"]
    assert "The link `box` moves farthest" in still.moves["a"]


def test_the_controls_speak_of_the_box(make):
    text = replay.markup("replay-x", make(), "replay/a.js", "replay/viewer.js", 300)
    root = BeautifulSoup(text, "html.parser").div
    assert json.loads(root["data-channels"]) == [
        {"name": "height", "unit": "m", "digits": 4},
        {"name": "vertical velocity", "unit": "m/s", "digits": 4},
    ]
    assert root.legend.get_text() == "Run of the box"
    assert root.select_one(".show").get_text() == "Show the box in 3D"
    assert root["data-alt"] == "The box in 3D, where it is at the sample that is shown."
    assert (root["data-orbit"], root["data-target"]) == ("30deg 72deg auto", "")
    assert [term.get_text() for term in root.select("dt")] == [
        "time", "height", "vertical velocity",
    ]  # fmt: skip
    assert [(r["data-mark"], r["data-levels"]) for r in root.select("input[type=radio]")] == [
        ("case-g1", "[]"),
        ("case-g2", "[]"),
    ]
    assert len(root.select(".plots > .plot")) == 2
    assert "robot" not in text
    assert "joint" not in text


def test_times_have_the_digits_of_their_grid(make):
    runs = make(Moving(("a",), link="box", thing="box"), a=falling(1.0, dt=0.0025))
    root = BeautifulSoup(replay.markup("x", runs, "a.js", "b.js", 1), "html.parser").div
    assert root["data-time-digits"] == "4"
    assert "fastest at 0.0750 s" in runs.moves["a"]


def test_a_picture_of_a_fall_draws_its_first_channel(make):
    runs, ax = make(), Figure().subplots()
    plotting.first_channel(ax, runs)
    assert ax.get_title("left") == "Height of the box"
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [s]", "z [m]")
    drawn = {line.get_label(): line for line in ax.get_lines()}
    assert list(drawn) == ["high", "low"]
    assert np.array_equal(drawn["low"].get_ydata(), runs.traces["low"].link_pos[:, 1, 2])
    assert drawn["high"].get_color() != drawn["low"].get_color()
    assert list(ax.patches) == []
