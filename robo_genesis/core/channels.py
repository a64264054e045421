"""Runs of one bundle as channels, which pictures draw and replays show."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, Trace

MEASURES = False

Run = Trace | BodyTrace


@dataclass(frozen=True, slots=True)
class Channel:
    """One quantity of several runs, with a value at each state.

    `head` is its name in the head of a table and at an axis; `digits` is the number of digits after
    the point in a readout. `values` by case have shape (n+1,) [unit].
    """

    name: str
    head: str
    unit: str
    digits: int
    values: Mapping[str, FloatArray]


@dataclass(frozen=True, slots=True)
class Level:
    """A reference for a channel, such as a target, drawn as lines across its plot.

    `mark` is the mark of the line in the palette, `legend` its sentence in a replay. `values` by
    case are in the unit of the channel; `texts` by case have the unit. `band` is the half width
    of an area around each line, 0 for none.
    """

    name: str
    channel: str
    mark: str
    legend: str
    values: Mapping[str, tuple[float, ...]]
    texts: Mapping[str, str]
    band: float = 0.0


@dataclass(frozen=True, slots=True)
class ReplayView:
    """The 3D view of runs.

    `thing` is the name of what moves: "robot". `alt` describes the view. `credit` names the authors
    of the shape, None for a shape of the scene itself.
    """

    thing: str
    alt: str
    credit: str | None = None


@dataclass(frozen=True, slots=True)
class Runs:
    """Runs with the same times; `subject` is the joint or body of the channels: `the box`.

    `moves` describes by case the motion, with `**strong**` and code as its only markup. `alt` and
    `caption` belong to a picture of the first channel.

    Raises:
        ValueError: there are no runs or no channels, or the runs differ in their times.
    """

    subject: str
    traces: Mapping[str, Run]
    links: Sequence[str]
    channels: Sequence[Channel]
    levels: Sequence[Level]
    moves: Mapping[str, str]
    view: ReplayView
    alt: str
    caption: str

    def __post_init__(self) -> None:
        if not self.traces or not self.channels:
            raise ValueError(
                f"{len(self.traces)} runs and {len(self.channels)} channels given; pictures and "
                "replays take at least one of each. Correct the lesson's declaration."
            )
        grids = {case: (trace.steps, trace.dt) for case, trace in self.traces.items()}
        if any(not np.array_equal(trace.t, self.t) for trace in self.traces.values()):
            found = ", ".join(f"{case} {n} × {dt:g} s" for case, (n, dt) in grids.items())
            raise ValueError(
                f"The runs have other times: {found}; pictures and replays take one grid. Record "
                "the cases with one outer step and one length, and vary the substeps."
            )

    @property
    def t(self) -> FloatArray:
        """Times of the states, (n+1,) [s]."""
        return next(iter(self.traces.values())).t

    def levels_of(self, channel: Channel) -> list[Level]:
        """Return the levels of a channel."""
        return [level for level in self.levels if level.channel == channel.name]


def farthest_link(links: Sequence[str], trace: Run) -> str:
    """Return a sentence about the link that moves farthest from its start."""
    distances = np.linalg.norm(trace.link_pos - trace.link_pos[0], axis=2).max(axis=0)  # (l,)
    name, distance = links[distances.argmax()], 100 * distances.max()
    return f"The link `{name}` moves farthest, by up to {distance:.1f} cm."
