"""What a lesson compares, and its runs as channels, which figures draw and replays show."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .scene import FloatArray
from .trace import BodyTrace, Trace

MEASURES = False

Run = Trace | BodyTrace


@dataclass(frozen=True, slots=True)
class Channel:
    """One quantity of several runs, with a value at each state.

    `head` is its name in the head of a table and at an axis; `digits` is the number of
    digits after the point in a readout. `values` by case have shape (n+1,) [unit];
    curves show those up to `top`, None for all.
    """

    name: str
    head: str
    unit: str
    digits: int
    values: Mapping[str, FloatArray]
    top: float | None = None


@dataclass(frozen=True, slots=True)
class Level:
    """A reference for a channel, such as a target, drawn as lines across its plot.

    `mark` is the mark of the line in the palette, `legend` its sentence in a replay.
    `values` by case are in the unit of the channel; `texts` by case have the unit.
    `band` is the half width of an area around each line, 0 for none.
    """

    name: str
    channel: str
    mark: str
    legend: str
    values: Mapping[str, tuple[float, ...]]
    texts: Mapping[str, str]
    band: float = 0.0


@dataclass(frozen=True, slots=True)
class Replay:
    """Cases that a lesson compares: they share pictures, a replay and the words for both.

    | field | meaning |
    |---|---|
    | `cases` | names of the runs |
    | `follows` | the joint of a robot, or link of free bodies, that sentences and curves follow |
    | `thing` | what moves, for a reader: "box" |
    | `axes` | of the world, along which a link is followed |
    | `goal` | by case and number of the state, the point (3,) that the hand is to reach [m]; the |
    | | curves then show its distance |
    | `hand` | the link of the hand |
    | `band` | half width of the settling band around the target of a joint |
    | `quality` | a sentence on one case, with its metrics in braces: `Rise time {rise_time}.` |
    | `rest` | height of a body at rest [m]; curves then show its clearance, close to zero |
    | `until` | end of the motion [s], which is shown first; None for the end of the runs |
    | `places` | for all cases in one view, the horizontal position (x, y) of each [m] |
    | `repeats` | whether each of these places also has what does not move |
    | `credit` | authors of the shape, None for a shape of the scene itself |
    | `view` | alternative text of the 3D view |
    | `filmed` | subject of the camera frames |

    Texts that are not given are made from the names.
    """

    cases: tuple[str, ...]
    follows: str
    thing: str
    axes: tuple[str, ...] = ("z",)
    goal: Callable[[str, int], FloatArray] | None = None
    hand: str = "hand"
    band: float = 0.0
    quality: str = ""
    rest: float | None = None
    until: float | None = None
    places: tuple[tuple[float, float], ...] = ()
    repeats: bool = False
    credit: str | None = None
    view: str = ""
    filmed: str = ""


@dataclass(frozen=True, slots=True)
class Runs:
    """Runs with the same times; `subject` is the joint or body of the channels: `the box`.

    `moves` describes by case the motion, with `**strong**` and code as its only markup.

    Raises:
        ValueError: the runs differ in their times.
    """

    replay: Replay
    subject: str
    traces: Mapping[str, Run]
    links: Sequence[str]
    channels: Sequence[Channel]
    moves: Mapping[str, str]
    levels: Sequence[Level] = ()

    def __post_init__(self) -> None:
        if any(not np.array_equal(trace.t, self.t) for trace in self.traces.values()):
            raise ValueError(
                "The runs have other times; pictures and replays take one grid. Record the cases "
                "with one outer step and one length, and vary the substeps."
            )

    @property
    def first(self) -> Run:
        """The run of the first case."""
        return next(iter(self.traces.values()))

    @property
    def t(self) -> FloatArray:
        """Times of the states, (n+1,) [s]."""
        return self.first.t

    def levels_of(self, channel: Channel) -> list[Level]:
        """Return the levels of a channel."""
        return [level for level in self.levels if level.channel == channel.name]
