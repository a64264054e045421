"""Runs of one bundle as channels: what pictures draw and replays play, whatever moved."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, Trace

Run = Trace | BodyTrace


@dataclass(frozen=True, slots=True)
class Channel:
    """One quantity of several runs, a value at each state.

    `head` names it in the head of a table and at an axis; `digits` stand after the point where a
    value is read out. `values` by case have shape (n+1,) [unit].
    """

    name: str
    head: str
    unit: str
    digits: int
    values: Mapping[str, FloatArray]


@dataclass(frozen=True, slots=True)
class Level:
    """What a channel is held against: lines across its plot.

    `mark` is the line's in the palette, `legend` the sentence of a replay about it. `values` by
    case, in the channel's unit, are drawn; `said` by case is their text. `band` is the half width
    of an area around each line, 0 for none.
    """

    name: str
    channel: str
    mark: str
    legend: str
    values: Mapping[str, tuple[float, ...]]
    said: Mapping[str, str]
    band: float = 0.0


@dataclass(frozen=True, slots=True)
class View:
    """How runs are shown in 3D.

    `thing` is what a button shows: "robot". `alt` describes it. `orbit` and `target` are those of
    the viewer's camera, in its own notation and frame (y up); empty, it chooses.
    `credit` names whose the shape is, None where it is the scene's own.
    """

    thing: str
    alt: str
    credit: str | None = None
    orbit: str = ""
    target: str = ""


@dataclass(frozen=True, slots=True)
class Runs:
    """Runs on one grid of times; `subject` is whose channels they are: `joint4`, `the box`.

    `moves` says by case, as Markdown, what a viewer would see move. `alt` and `caption` stand with
    a picture of the first channel.

    Raises:
        ValueError: there are no runs or no channels, or the runs differ in their times.
    """

    subject: str
    traces: Mapping[str, Run]
    links: Sequence[str]
    channels: Sequence[Channel]
    levels: Sequence[Level]
    moves: Mapping[str, str]
    view: View
    alt: str
    caption: str

    def __post_init__(self) -> None:
        if not self.traces or not self.channels:
            raise ValueError(
                f"{len(self.traces)} runs and {len(self.channels)} channels given; pictures and "
                "replays take at least one of each. Name them in robo_genesis/lessons/registry.py."
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
        """Return what a channel is held against."""
        return [level for level in self.levels if level.channel == channel.name]
