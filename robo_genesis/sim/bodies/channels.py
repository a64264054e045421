"""Runs of free bodies as channels: position and velocity of the origin of a link along axes."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from robo_genesis.core.channels import Channel, Replay, Runs
from robo_genesis.core.text import time_digits, with_unit
from robo_genesis.core.trace import BodyTrace

MEASURES = False

CLOSE = 20.0  # Largest clearance that is drawn [mm]


class Axis(NamedTuple):
    """Words for an axis of the world: its two channels, a position on it, and both directions."""

    name: str
    position: str
    velocity: str
    at: str
    forward: str
    backward: str

    @property
    def number(self) -> int:
        """Its place in an array of coordinates."""
        return "xyz".index(self.name)


LEVEL = ("moved on by", "moved back by")

AXES = {
    "x": Axis("x", "x", "velocity along x", "x =", *LEVEL),
    "y": Axis("y", "y", "velocity along y", "y =", *LEVEL),
    "z": Axis("z", "height", "vertical velocity", "a height of", "rose by", "fell by"),
}


def runs(traces: Mapping[str, BodyTrace], links: Sequence[str], replay: Replay) -> Runs:
    """Return the runs of free bodies with their descriptions.

    Args:
        traces: by case.
        links: names, in the order of the traces' arrays.
        replay: what is shown of them; its axes are keys of `AXES`.

    Raises:
        ValueError: the runs have no such link; as `Runs`.
        KeyError: an axis is not in `AXES`.
    """
    k, thing = links.index(replay.follows), replay.thing
    followed = [AXES[name] for name in replay.axes]
    return Runs(
        replay,
        subject=f"the {thing}",
        traces=traces,
        links=links,
        channels=[
            one for axis in followed for one in _channels(traces, k, axis, replay.rest)
        ],
        moves={
            case: f"**{case}**: the {thing} "
            + "; it ".join(_along(trace, k, axis) for axis in followed)
            + "."
            for case, trace in traces.items()
        },
    )


def _channels(
    traces: Mapping[str, BodyTrace], k: int, axis: Axis, rest: float | None
) -> tuple[Channel, Channel]:
    """Return position and velocity of the origin of link `k` along an axis.

    With the height at `rest` [m], that along z is the clearance, and its curve is close
    to zero.
    """
    position = {
        case: trace.link_pos[:, k, axis.number] for case, trace in traces.items()
    }
    velocity = {
        case: trace.link_vel[:, k, axis.number] for case, trace in traces.items()
    }
    where = Channel(axis.position, axis.name, "m", 4, position)
    if rest is not None and axis is AXES["z"]:
        clear = {case: 1000 * (values - rest) for case, values in position.items()}
        where = Channel("clearance", "clearance", "mm", 2, clear, top=CLOSE)
    return where, Channel(axis.velocity, "ẋẏż"[axis.number], "m/s", 4, velocity)


def _along(trace: BodyTrace, k: int, axis: Axis) -> str:
    """Describe where the origin of link `k` starts and ends along an axis, and its top speed."""
    path, velocity = (
        array[:, k, axis.number] for array in (trace.link_pos, trace.link_vel)
    )
    distance, fastest = float(path[-1] - path[0]), int(np.abs(velocity).argmax())
    start, end = (f"{axis.at} {with_unit(value, 'm')}" for value in path[[0, -1]])
    ends = f"starts at {start} and ends at {end}"
    if float(f"{distance:.4f}") != 0:
        verb = axis.forward if distance > 0 else axis.backward
        ends += f": it {verb} {with_unit(abs(distance), 'm')}"
    if float(f"{velocity[fastest]:.4f}") == 0:
        return f"{ends}, at rest all the time"
    when = with_unit(trace.t[fastest], "s", time_digits(trace.dt))
    return f"{ends}, fastest at {when} with {with_unit(velocity[fastest], 'm/s')}"
