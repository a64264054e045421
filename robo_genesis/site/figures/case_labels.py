"""The words for runs that a reader sees in place of the names in bundles."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from robo_genesis.core.channels import Runs
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


def labelled(runs: Runs, lesson: str) -> Runs:
    """Return runs with the words of their lesson in place of their names."""
    words = {case: label(lesson, case) for case in runs.traces}

    def renamed(by_case: Mapping[str, Any]) -> dict[str, Any]:
        return {words[case]: value for case, value in by_case.items()}

    return replace(
        runs,
        traces=renamed(runs.traces),
        channels=[replace(one, values=renamed(one.values)) for one in runs.channels],
        levels=[
            replace(one, values=renamed(one.values), texts=renamed(one.texts))
            for one in runs.levels
        ],
        moves={
            words[case]: text.replace(f"**{case}**", f"**{words[case]}**")
            for case, text in runs.moves.items()
        },
    )
