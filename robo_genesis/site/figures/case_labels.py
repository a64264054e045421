"""The words for runs that a reader sees in place of the names in bundles."""

from collections.abc import Mapping

from robo_genesis.lessons import LESSONS, course_marks, find_lesson


def labels_of(lesson: str) -> Mapping[str, str]:
    """Return `LABELS` in a lesson's `spec`: words by the name of a run, for some runs."""
    return getattr(find_lesson(lesson).spec, "LABELS", {})


def label(lesson: str, case: str) -> str:
    """Return the words of a lesson for a run, else its name."""
    return labels_of(lesson).get(case, case)


# The palette's mark of each case that has one of its own, also by its words.
MARKS = course_marks() | {
    words: course_marks()[case]
    for lesson in LESSONS
    for case, words in labels_of(lesson).items()
    if case in course_marks()
}
