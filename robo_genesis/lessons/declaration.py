"""The form of a lesson's declaration in its `__init__.py`."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from robo_genesis.core.checks import Check
from robo_genesis.core.metrics import CaseMetrics, Record
from robo_genesis.core.orderings import Relation
from robo_genesis.core.text import listed
from robo_genesis.core.trace import BodyTrace, ContactTrace, Trace
from robo_genesis.sim.joints import JointMap

COMMON_MODULES = (
    "core.checks", "core.metrics", "core.quantities", "core.scene", "core.trace",
    "sim.end_state", "sim.joints", "sim.session",
)  # fmt: skip
"""Modules that affect the measurements of every page."""


class Specification(Protocol):
    """The data in a lesson's `spec.py` that other sub-packages read."""

    @property
    def MINIMUM_HARDWARE(self) -> str:  # noqa: N802 - a module's constant
        """The backend whose evidence a release requires."""

    @property
    def CASES(self) -> Mapping[str, Any]:  # noqa: N802
        """The runs of the lab by name."""

    @property
    def RESOLUTION(self) -> Mapping[str, float]:  # noqa: N802
        """By unit, the difference below which two values count as equal."""

    @property
    def TOLERANCES(self) -> Mapping[str, tuple[float, float]]:  # noqa: N802
        """By unit or metric, (atol, rtol) between engine versions or backends."""

    @property
    def RELATIONS(self) -> tuple[Relation, ...]:  # noqa: N802
        """The orderings that the lesson claims."""


class BundleReader(Protocol):
    """The files of one bundle, as the `recompute` of a lesson reads them.

    Every method raises BundleRefused if a file is damaged or does not match the arguments.
    """

    @property
    def page(self) -> str:
        """The page that recorded the bundle."""

    @property
    def end_state(self) -> str:
        """`camera` if the run was rendered, else `schematic`."""

    def frames(self) -> dict[str, np.ndarray]:
        """Return the camera frames by name, each (height, width, 3)."""

    def joints(self) -> JointMap:
        """Return the joint of each DOF of the arrays."""

    def traces(
        self, required: Iterable[str], check_coords: Callable[[Mapping[str, list[str]]], None]
    ) -> dict[str, Trace]:
        """Return all runs of joints by case, after `check_coords` has accepted their labels."""

    def bodies(self, cases: Iterable[str], link: str) -> dict[str, BodyTrace]:
        """Return the runs of one free body by case; the bundle has no other runs."""

    def contacts(self, cases: Iterable[str], link: str) -> dict[str, ContactTrace]:
        """Return the runs of one free body with its contacts by case; there are no other runs."""

    def counts(self, group: str, names: Iterable[str]) -> dict[str, int]:
        """Return counts that the engine reported; the group has no others."""

    def recorded(self, group: str) -> dict[str, float]:
        """Return the observed values of a group of metrics.json."""

    def readings(self, group: str, names: Iterable[str]) -> dict[str, float]:
        """Return values that the engine reported; the group has no others."""


@dataclass(frozen=True, slots=True)
class Recomputed:
    """Recomputed content of a bundle: `metrics.json` and the outcomes of the named checks."""

    metrics: Mapping[str, Mapping[str, Record]]
    outcomes: Sequence[Check]


@dataclass(frozen=True, slots=True)
class MeasuringPage:
    """A page that runs the engine and writes a bundle.

    `parameters` returns every configured input as JSON values. `modules` are the modules whose
    source affects the measurements, such as `core.trace`: a change in one makes evidence stale.
    The `spec` of a lesson is not among them, because `parameters` covers it. `cases` are the cases
    of the lesson that the page runs, None for all.
    """

    parameters: Callable[[], dict[str, Any]]
    modules: tuple[str, ...]
    cases: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Drawn:
    """Cases that share one plot and one replay.

    `until` is the end of the time axis of the small plot [s], None for the end of the runs.
    """

    cases: tuple[str, ...]
    until: float | None = field(default=None, kw_only=True)

    @property
    def names(self) -> str:
        """The cases as words: `G1, G2 and G3`."""
        return listed(self.cases)


@dataclass(frozen=True, slots=True)
class Compared(Drawn):
    """Cases that move one joint of a robot; `band` is the half width of its settling band."""

    joint: str
    band: float


@dataclass(frozen=True, slots=True)
class Moving(Drawn):
    """Cases of free bodies, plotted as position and velocity of one link.

    `link` is its name in the arrays, and `thing` its name for a reader, such as "box". `axes` are
    axes of the world. The position along the first axis is the curve of the small pictures.
    """

    link: str
    thing: str
    axes: tuple[str, ...] = ("z",)


@dataclass(frozen=True, slots=True)
class Filmed:
    """The subject of the camera frames in the words of their captions, and their run."""

    thing: str
    case: str = "the baseline"


@dataclass(frozen=True, slots=True)
class Lesson:
    """One lesson.

    | field | meaning |
    |---|---|
    | `spec` | its module of data |
    | `metrics` | by case, the class of its metrics |
    | `pages` | the measuring pages by name |
    | `recompute` | returns metrics and checks from the files of a bundle |
    | `filmed` | the subject of its camera frames |
    | `compared` | the cases of its pictures and its replay, None for no replay |
    | `further` | further replays by name |
    """

    spec: Specification
    metrics: Mapping[str, type[CaseMetrics]]
    pages: Mapping[str, MeasuringPage]
    recompute: Callable[[BundleReader], Recomputed]
    filmed: Filmed
    compared: Compared | Moving | None = None
    further: Mapping[str, Moving] = field(default_factory=dict)

    def about_metrics(self, what: str) -> dict[str, Any]:
        """Return `unit`, `label` or `noun` of each of its metrics by name."""
        return {name: v for of in self.metrics.values() for name, v in of.about(what).items()}
