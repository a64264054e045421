"""The words for runs that a reader sees in place of the names in bundles."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from robo_genesis.core.channels import Runs
from robo_genesis.lessons.registry import find_lesson


def label(lesson: str, case: str) -> str:
    """Return the words that `LABELS` in a lesson's `spec` has for a run, else its name."""
    labels: Mapping[str, str] = getattr(find_lesson(lesson).spec, "LABELS", {})
    return labels.get(case, case)


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
