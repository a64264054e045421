"""What `make evidence` prints in the end: the facts of one run, or a table of all labs."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.text import printable

COLUMNS = ("lab", "backend", "device", "state", "checks", "seconds", "place or reason")
STATUS = {"recorded": 0, "kept": 0, "not run": 0, "failed": 1, "interrupted": 130}
"""The exit status that each state of a lab asks for; the largest wins."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one lab: a state of `STATUS`, the place of its bundle or why there is none.

    `facts` are those of the bundle's manifest, `seconds` the time of the run.
    """

    lesson: str
    state: str
    where: str = ""
    facts: Any = None
    seconds: float | None = None


def summary(place: Path, facts: Any) -> list[str]:
    """Return the last lines of a recording: the facts of the run, and what to check by eye.

    Args:
        place: where the bundle is.
        facts: the facts about the run in its manifest.
    """
    files = [path for path in place.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files) / 1e6
    backend, render = facts.backend, facts.render
    drawn = " (drawn in software)" if render.software else ""
    return [
        f"Recorded: {place}",
        f"Backend: requested {backend.requested}, actual {backend.actual}, "
        f"device {backend.device_name}",
        f"Engine: {project.ENGINE} {facts.engine.version}, "
        f"quadrants {facts.engine.quadrants_version}, torch {backend.torch_version}",
        f"Camera: {render.renderer}{drawn}",
        f"Checks passed: {sum(check.passed for check in facts.checks)} of {len(facts.checks)}. "
        f"Engine warnings kept: {len(facts.warnings)}.",
        f"Files: {len(files)}, {size:.1f} MB",
        checkout(facts.git),
        f"Before you commit: {look(place)}",
    ]


def look(place: Path) -> str:
    """Return what to check by eye in the folder of a bundle."""
    return (
        f"look at both pictures in {place / 'frames'}, read log.txt, and check that manifest.json "
        "names nothing private of your machine."
    )


def checkout(git: Any) -> str:
    """Return a line that says which sources ran."""
    if git is None:
        return "Checkout: no git here, so no commit is recorded; a release refuses that."
    if git.dirty:
        return (
            f"Checkout: changed since commit {git.commit[:12]}, and the manifest says so; a "
            "release refuses that. Commit or stash, then record each lab again with LESSON=name."
        )
    return f"Checkout: clean, commit {git.commit[:12]}"


def table(outcomes: Sequence[Outcome], backend: str) -> list[str]:
    """Return one aligned line for each lab below the names of the columns."""
    rows = [COLUMNS, *(_row(outcome, backend) for outcome in outcomes)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(f"{text:{width}}" for text, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _row(outcome: Outcome, backend: str) -> tuple[str, ...]:
    facts, device, checks = outcome.facts, "–", "–"
    if facts:
        device = printable(facts.backend.device_name)
        checks = f"{sum(check.passed for check in facts.checks)} of {len(facts.checks)}"
    seconds = "–" if outcome.seconds is None else f"{outcome.seconds:.0f}"
    where = printable(outcome.where)
    return outcome.lesson, backend, device, outcome.state, checks, seconds, where
