"""What a lesson declares in its `__init__.py` for the evidence, the build and the site."""

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
"""Modules that decide what any page measures."""


class Specification(Protocol):
    """The data in a lesson's `spec.py` that other sub-packages read."""

    @property
    def MINIMUM_HARDWARE(self) -> str:  # noqa: N802 - a module's constant
        """The backend whose evidence a release requires."""

    @property
    def CASES(self) -> Mapping[str, Any]:  # noqa: N802
        """The runs of its lab by name."""

    @property
    def RESOLUTION(self) -> Mapping[str, float]:  # noqa: N802
        """By unit, the difference below which two measured values are called equal."""

    @property
    def TOLERANCES(self) -> Mapping[str, tuple[float, float]]:  # noqa: N802
        """By unit or metric, (atol, rtol) between engine versions or backends."""

    @property
    def RELATIONS(self) -> tuple[Relation, ...]:  # noqa: N802
        """The orderings that it claims."""


class BundleReader(Protocol):
    """The files of one bundle, as the evidence hands them to a lesson's `recompute`.

    Every method raises BundleRefused where a file is damaged or not what the arguments ask for.
    """

    @property
    def page(self) -> str:
        """The page that recorded the bundle."""

    @property
    def end_state(self) -> str:
        """`camera` where the run was rendered, else `schematic`."""

    def frames(self) -> dict[str, np.ndarray]:
        """Return the camera frames by name, each (height, width, 3)."""

    def joints(self) -> JointMap:
        """Return the joint behind each DOF of the arrays."""

    def traces(
        self, required: Iterable[str], check_coords: Callable[[Mapping[str, list[str]]], None]
    ) -> dict[str, Trace]:
        """Return all runs of joints by case, once their labels have passed `check_coords`."""

    def bodies(self, cases: Iterable[str], link: str) -> dict[str, BodyTrace]:
        """Return the runs of one free body by case; the bundle holds no others."""

    def contacts(self, cases: Iterable[str], link: str) -> dict[str, ContactTrace]:
        """Return the runs of one free body with its contacts by case; it holds no others."""

    def counts(self, group: str, names: Iterable[str]) -> dict[str, int]:
        """Return counts that the engine reported; the group holds no others."""

    def recorded(self, group: str) -> dict[str, float]:
        """Return whatever values a group of metrics.json has, those observed."""

    def readings(self, group: str, names: Iterable[str]) -> dict[str, float]:
        """Return values that the engine reported; the group holds no others."""


@dataclass(frozen=True, slots=True)
class Recomputed:
    """What the runs of a bundle give: `metrics.json` and the outcomes of the named checks."""

    metrics: Mapping[str, Mapping[str, Record]]
    outcomes: Sequence[Check]


@dataclass(frozen=True, slots=True)
class MeasuringPage:
    """A page that runs the engine and leaves a bundle.

    `parameters` returns every configured input as JSON values. `modules` are those whose source
    decides what is measured, as `core.trace`: a change in one makes evidence stale. A lesson's
    `spec` is not among them, because its `parameters` cover it. `cases` are those of the lesson's
    cases that the page runs, None for all.
    """

    parameters: Callable[[], dict[str, Any]]
    modules: tuple[str, ...]
    cases: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Drawn:
    """Cases that share one plot and one replay.

    `until` ends the time axis of the small plot [s], where the rest is one flat line.
    """

    cases: tuple[str, ...]
    until: float | None = field(default=None, kw_only=True)

    @property
    def names(self) -> str:
        """The cases as words: `G1, G2 and G3`."""
        return listed(self.cases)


@dataclass(frozen=True, slots=True)
class Compared(Drawn):
    """Cases of a robot that move one joint; `band` is the half width of its settling band."""

    joint: str
    band: float


@dataclass(frozen=True, slots=True)
class Moving(Drawn):
    """Cases of free bodies: the link that curves follow, by its name in the record, and its axes.

    `thing` is what a reader sees move: "box". `axes` are of the world; each gives two curves,
    position and velocity. The first position represents the lesson in small pictures.
    """

    link: str
    thing: str
    axes: tuple[str, ...] = ("z",)


@dataclass(frozen=True, slots=True)
class Filmed:
    """What camera frames show, in the words of their captions, and in which run."""

    thing: str
    case: str = "the baseline"


@dataclass(frozen=True, slots=True)
class Lesson:
    """One lesson.

    | field | meaning |
    |---|---|
    | `spec` | its module of data |
    | `metrics` | by case, the class of its metrics |
    | `pages` | those that measure, by name |
    | `recompute` | metrics and checks from the files of a bundle |
    | `filmed` | what its camera frames show |
    | `compared` | the cases that its pictures and its replay show; None for none |
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
