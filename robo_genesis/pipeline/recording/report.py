"""What `make evidence` prints in the end: a table of labs, and what to check before a commit."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.core.text import printable

COLUMNS = ("lab", "backend", "device", "state", "checks", "seconds", "place or reason")

# The exit status that each state of a lab asks for; the largest wins.
STATUS = {"recorded": 0, "kept": 0, "failed": 1, "interrupted": 130}


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


def report(outcomes: Sequence[Outcome], backend: str, evidence: Path) -> Iterator[str]:
    """Yield one aligned line for each lab, its checkout, and what to check by eye.

    Args:
        outcomes: of the labs that were tried.
        backend: that was found.
        evidence: the folder of all recorded bundles.
    """
    rows = [COLUMNS, *(_row(outcome, backend) for outcome in outcomes)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "  ".join(
            f"{text:{width}}" for text, width in zip(row, widths, strict=True)
        ).rstrip()
    facts = [outcome.facts for outcome in outcomes if outcome.facts]
    yield from dict.fromkeys(checkout(fact.git) for fact in facts)
    if facts:
        yield (
            f"Before you commit: look at both pictures in {evidence / '*' / backend / 'frames'}, "
            "read log.txt, and check that manifest.json names nothing private of your machine."
        )


def checkout(git: Any) -> str:
    """Return a line that says which sources ran."""
    if git is None:
        return (
            "Checkout: no git here, so no commit is recorded; a release refuses that."
        )
    if git.dirty:
        return (
            f"Checkout: changed since commit {git.commit[:12]}, and the manifest says so; a "
            "release refuses that. Commit or stash, then record each lab again with LESSON=name."
        )
    return f"Checkout: clean, commit {git.commit[:12]}"


def _row(outcome: Outcome, backend: str) -> tuple[str, ...]:
    facts, device, checks = outcome.facts, "–", "–"
    if facts:
        device = printable(facts.backend.device_name)
        checks = f"{sum(check.passed for check in facts.checks)} of {len(facts.checks)}"
    seconds = "–" if outcome.seconds is None else f"{outcome.seconds:.0f}"
    return (
        outcome.lesson,
        backend,
        device,
        outcome.state,
        checks,
        seconds,
        printable(outcome.where),
    )
