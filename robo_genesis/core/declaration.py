"""The form of a lesson's declaration in its `__init__.py`."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Protocol

from robo_genesis.core.channels import ReplayView
from robo_genesis.core.checks import claim_of
from robo_genesis.core.comparison import Relation
from robo_genesis.core.experiment import MeasuringPage
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.text import listed

MEASURES = False


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


@dataclass(frozen=True, slots=True)
class Drawn:
    """Cases that share one plot and one replay.

    `until` is the end of the time axis of the small plot [s], None for the end of the runs. With
    `places`, horizontal positions (x, y) [m], the replay shows all cases at once, each at its own.
    """

    cases: tuple[str, ...]
    until: float | None = field(default=None, kw_only=True)
    places: tuple[tuple[float, float], ...] = field(default=(), kw_only=True)

    @property
    def names(self) -> str:
        """The cases as words: `G1, G2 and G3`."""
        return listed(self.cases)


@dataclass(frozen=True, slots=True)
class Compared(Drawn):
    """Cases that move one joint of a robot; `band` is the half width of its settling band.

    `alt` and `caption` belong to a picture of the joint's position. `quality` is a sentence about
    one case with its metrics by name in braces: `Rise time {rise_time}.`
    """

    joint: str
    band: float
    view: ReplayView
    alt: str
    caption: str
    quality: str


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
    | `filmed` | the subject of its camera frames |
    | `compared` | the cases of its pictures and its replay, None for no replay |
    | `further` | further replays by name |
    | `marks` | the palette's marks of its cases; `baseline` needs none |
    """

    spec: Specification
    metrics: Mapping[str, type[CaseMetrics]]
    pages: Mapping[str, MeasuringPage]
    filmed: Filmed
    compared: Compared | Moving | None = None
    further: Mapping[str, Moving] = field(default_factory=dict)
    marks: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse checks without a claim; raises as `claim_of`."""
        for page in self.pages.values():
            for check in page.checks:
                claim_of(check)

    def about_metrics(self, what: str) -> dict[str, Any]:
        """Return `unit`, `label` or `noun` of each of its metrics by name."""
        return {name: v for of in self.metrics.values() for name, v in of.about(what).items()}


def on_demand(package: str, **offered: str) -> Callable[[str], Any]:
    """Return the `__getattr__` of a lesson: what a page uses is imported when it is used.

    A module of the lesson's folder needs no argument. The readers of import statements know the
    arguments as well, so each is written out.

    Args:
        package: the `__name__` of the lesson.
        offered: by name, the module that has it, or that it is: `run` of the lesson's folder, or a
            module of another sub-package by its whole name.
    """

    def imported(name: str) -> Any:
        place = offered.get(name, name)
        module = place if "." in place else f"{package}.{place}"
        if name[:1] == "_" or (name not in offered and not find_spec(module)):
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        found = import_module(module)
        return getattr(found, name, found) if name in offered else found

    return imported
