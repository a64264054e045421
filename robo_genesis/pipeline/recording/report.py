"""What `make evidence` prints in the end: a table of labs, and what to check before a commit."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.core.text import printable

# The exit status that each state of a lab asks for; the largest wins.
STATUS = {"recorded": 0, "kept": 0, "failed": 1, "interrupted": 130}


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one lab: a state of `STATUS`, the place of its bundle or why there is none.

    `manifest` is that of the bundle.
    """

    lesson: str
    state: str
    where: str = ""
    manifest: Any = None


def report(outcomes: Sequence[Outcome], backend: str, evidence: Path) -> Iterator[str]:
    """Yield one line for each lab, the state of its checkout, and what to check by eye.

    Args:
        outcomes: of the labs that were tried.
        backend: that was found.
        evidence: the folder of all recorded bundles.
    """
    for outcome in outcomes:
        line = f"{outcome.lesson}  {backend}  {outcome.state:11}  {outcome.where}"
        if manifest := outcome.manifest:
            passed = sum(check.passed for check in manifest.checks)
            line += f"  {passed} of {len(manifest.checks)} checks, {manifest.backend.device_name}"
        yield printable(line)
        if manifest and (manifest.git is None or manifest.git.dirty):
            yield (
                "     It names no commit, or a tree with changes, which a release refuses. Commit, "
                f"then record it again with LESSON={outcome.lesson}."
            )
    if any(outcome.manifest for outcome in outcomes):
        yield (
            f"Before you commit: look at both pictures in {evidence / '*' / backend / 'frames'}, "
            "read log.txt, and check that manifest.json names nothing private of your machine."
        )
