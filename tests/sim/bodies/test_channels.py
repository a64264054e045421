"""Channels of free bodies are the record, and their motion is described by it."""

import numpy as np
import pytest
from falling import LINKS, G, falling

from robo_genesis.core.channels import Replay
from robo_genesis.sim.bodies import channels as body_channels

HIGH, LOW = falling(2.0), falling(1.0)


def runs(link="box", thing="box", axes=("z",), **traces):
    traces = traces or {"high": HIGH, "low": LOW}
    return body_channels.runs(traces, LINKS, Replay((*traces,), link, thing, axes))


def test_channels_are_position_and_velocity_of_the_record_along_each_axis():
    found = runs(axes=("x", "z"))
    assert [(c.name, c.head, c.unit) for c in found.channels] == [
        ("x", "x", "m"),
        ("velocity along x", "ẋ", "m/s"),
        ("height", "z", "m"),
        ("vertical velocity", "ż", "m/s"),
    ]
    *_, height, velocity = found.channels
    for case, trace in found.traces.items():
        assert np.array_equal(height.values[case], trace.link_pos[:, 1, 2])
        assert np.array_equal(velocity.values[case], trace.link_vel[:, 1, 2])
    assert (list(found.levels), found.subject) == ([], "the box")


def test_runs_with_other_times_are_refused():
    with pytest.raises(ValueError, match="take one grid"):
        runs(high=HIGH, low=falling(1.0, dt=0.02))


DROP = G * 0.3**2 / 2


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (
            {},
            "**high**: the box starts at a height of 2.0000 m and ends at a height of "
            f"{2 - DROP:.4f} m: it fell by {DROP:.4f} m, fastest at 0.30 s with −{G * 0.3:.4f} "
            "m/s.",
        ),
        (
            {"axes": ("x",), "high": falling(1.0, drift=-0.5)},
            "starts at x = 0.0000 m and ends at x = −0.1500 m: it moved back by 0.1500 m",
        ),
        ({"link": "stand"}, "ends at a height of 0.0000 m, at rest all the time."),
        ({"high": falling(1.0, dt=0.0025)}, "fastest at 0.0750 s"),
    ],
)
def test_the_motion_is_described_by_the_record(given, sentence):
    assert sentence in runs(**given).moves["high"]
