"""The lessons of the course: what each one declares, and which of its pages measure."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from robo_genesis import drop_metrics, l02, l03, l04, l04_studies, metrics
from robo_genesis.tables import listed

Relation = tuple[tuple[str, str], str, str, float]
"""A claimed ordering: (first case, second case), metric, order, margin."""


class Specification(Protocol):
    """What the module of a lesson declares; it is data, and says more of its own experiment."""

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


@dataclass(frozen=True, slots=True)
class MeasuringPage:
    """A page that runs the engine and leaves a bundle.

    `parameters` returns every configured input as JSON values; `modules` are those whose source
    decides what is measured: a change in one makes evidence stale. A lesson's own module is none of
    them: what it decides is in the parameters. `cases` are those of the lesson's cases that it
    runs, None for all.
    """

    parameters: Callable[[], dict[str, Any]]
    modules: tuple[str, ...]
    cases: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Drawn:
    """Cases that are drawn over each other and played.

    `until` ends the window of the small plot [s], where what comes later is one flat line.
    """

    cases: tuple[str, ...]
    until: float | None = field(default=None, kw_only=True)

    @property
    def names(self) -> str:
        """The cases as words: `G1, G2 and G3`."""
        return listed(self.cases)


@dataclass(frozen=True, slots=True)
class Compared(Drawn):
    """Cases of a robot that move one joint."""

    joint: str


@dataclass(frozen=True, slots=True)
class Moving(Drawn):
    """Cases of free bodies: the link that curves follow, by its name in the record, and along what.

    `thing` is what a reader sees move: "box". `axes` are of the world; each gives two curves,
    position and velocity, and the first position stands for the lesson in small pictures.
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
    """One lesson: its module, the names of each case's metrics, its pages that measure.

    Without `compared`, its recorded runs are shown by their facts and tables alone. `further` are
    cases that a page may play beside these, each under a name of its own.
    """

    spec: Specification
    metrics: Mapping[str, tuple[str, ...]]
    pages: Mapping[str, MeasuringPage]
    filmed: Filmed
    compared: Compared | Moving | None = None
    further: Mapping[str, Moving] = field(default_factory=dict)


COMMON_MODULES = (
    "checks", "posture", "records", "robot_model", "runtime", "scene_config", "trace",
)  # fmt: skip
DROP_MODULES = (*COMMON_MODULES, "drop_checks", "drop_metrics", "falling", "free_bodies")
CONTACT_MODULES = (
    *COMMON_MODULES, "contact_checks", "contact_metrics", "contacts", "energy", "falling",
    "free_bodies", "metrics", "sliding",
)  # fmt: skip
STEP_MODULES = (*COMMON_MODULES, "joint_control", "metrics", "step_checks")
STUDY_MODULES = ("dynamics", "second_engine", "studies", "study_checks", "theory")

LESSONS = {
    l02.LESSON: Lesson(
        spec=l02,
        metrics=dict.fromkeys(l02.CASES, tuple(drop_metrics.SOURCES)),
        pages={
            "lab": MeasuringPage(l02.parameters, DROP_MODULES),
            l02.STUDY_PAGE: MeasuringPage(
                l02.study_parameters, (*DROP_MODULES, "life_cycle", "substep_study")
            ),
        },
        filmed=Filmed("the box"),
        compared=Moving(tuple(l02.CASES), link=l02.LINK, thing="box"),
    ),
    l03.LESSON: Lesson(
        spec=l03,
        metrics=l03.METRICS,
        pages={
            "lab": MeasuringPage(l03.parameters, CONTACT_MODULES),
            l03.STUDY_PAGE: MeasuringPage(
                l03.study_parameters,
                (*CONTACT_MODULES, "contact_studies", "robot_shape", "second_contacts"),
                cases=tuple(l03.REPEATED),
            ),
        },
        filmed=Filmed("the cube"),
        compared=Moving(("baseline", "dt10_sub1"), link=l03.LINK, thing="cube", until=0.5),
        further={"slides": Moving(tuple(l03.SLIDES), link=l03.LINK, thing="cube", axes=("x", "z"))},
    ),
    l04.LESSON: Lesson(
        spec=l04,
        metrics=dict.fromkeys(l04.CASES, tuple(metrics.SOURCES)),
        pages={
            "lab": MeasuringPage(l04.parameters, STEP_MODULES),
            l04_studies.PAGE: MeasuringPage(
                lambda: l04.parameters() | l04_studies.parameters(), STEP_MODULES + STUDY_MODULES
            ),
        },
        filmed=Filmed("the Franka"),
        compared=Compared(tuple(l04_studies.COMPARED), l04.STEPPED_JOINT, until=0.6),
    ),
}
"""By name, in the order in which a reader meets them."""


def find_lesson(name: str) -> Lesson:
    """Return a lesson by its name.

    Raises:
        LookupError: there is none; the message lists those there are.
    """
    if name not in LESSONS:
        raise LookupError(f"{name!r} is no lesson. Choices: {', '.join(LESSONS)}.")
    return LESSONS[name]


def compared_cases(lesson: str) -> Compared | Moving | None:
    """Return what a lesson's pictures hold against each other, None where that is nothing."""
    return LESSONS[lesson].compared if lesson in LESSONS else None


def drawn_cases(lesson: str, name: str = "") -> Compared | Moving:
    """Return the cases that a replay plays: the compared ones, or further ones by their name.

    Raises:
        LookupError: the lesson has none of that name; the message says which there are.
    """
    compared = compared_cases(lesson)
    if compared is None:
        raise LookupError(
            f"the lesson {lesson} compares no cases. With cases, and what they move, in "
            "robo_genesis/lessons.py it has a replay."
        )
    further = LESSONS[lesson].further
    if name and name not in further:
        known = ", ".join(further) or "none"
        raise LookupError(f"{lesson} has no further cases called {name!r}. Choices: {known}.")
    return further[name] if name else compared


def filmed(lesson: str) -> Filmed:
    """Return what the camera frames of a lesson show, in no lesson's words if it is not listed."""
    return LESSONS[lesson].filmed if lesson in LESSONS else Filmed("the scene")


def find_page(lesson: str, page: str) -> MeasuringPage:
    """Return a page that measures.

    Raises:
        LookupError: the lesson has none of that name; the message lists those there are.
    """
    pages = find_lesson(lesson).pages
    if page not in pages:
        known = ", ".join(f"{lesson}/{name}" for name in pages)
        raise LookupError(f"{lesson}/{page} is no page that measures. Choices: {known}.")
    return pages[page]
