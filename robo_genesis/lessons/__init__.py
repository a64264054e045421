"""The lessons of the course: each folder of this sub-package with an `__init__.py`."""

from functools import cache
from importlib import import_module
from pathlib import Path

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.experiment import MeasuringPage

# The names of all lessons, in the order of the course.
LESSONS = tuple(
    sorted(of.parent.name for of in Path(__file__).parent.glob("*/__init__.py"))
)


@cache
def course_marks() -> dict[str, str]:
    """Return the palette's mark of each case that has one of its own, from all lessons.

    A lesson gives them as `CASE_MARKS` in its `spec`, if it has any; lessons give one
    name one mark.
    """
    found = {"baseline": "baseline"}
    for name in LESSONS:
        found |= getattr(find_lesson(name).spec, "CASE_MARKS", {})
    return found


def find_lesson(name: str) -> Lesson:
    """Return a lesson by its name; it is imported at its first use.

    Raises:
        LookupError: it does not exist; the message lists the lessons.
    """
    if name not in LESSONS:
        raise LookupError(
            f"Lesson {name!r} does not exist. Choices: {', '.join(LESSONS)}."
        )
    return import_module(f"{__name__}.{name}.pages").LESSON


def find_replay(lesson: str, name: str = "") -> Replay:
    """Return a replay of a lesson by its name, the first without a name.

    Raises:
        LookupError: it does not exist; the message lists those of the lesson.
    """
    replays = find_lesson(lesson).replays
    name = name or next(iter(replays), "")
    if name not in replays:
        known = ", ".join(replays) or "none"
        raise LookupError(f"{lesson} has no replay called {name!r}. Choices: {known}.")
    return replays[name]


def find_page(lesson: str, page: str) -> MeasuringPage:
    """Return a page that measures.

    Raises:
        LookupError: it does not exist; the message lists the measuring pages of the
            lesson.
    """
    pages = find_lesson(lesson).pages
    if page not in pages:
        known = ", ".join(f"{lesson}/{name}" for name in pages)
        raise LookupError(
            f"{lesson}/{page} does not measure anything. Choices: {known}."
        )
    return pages[page]
