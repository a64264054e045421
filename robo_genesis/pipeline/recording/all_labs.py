"""`make evidence`: record all labs, one after the other, except those that are recorded already."""

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from robo_genesis.core.project import ProjectError
from robo_genesis.core.refusals import BundleRefused
from robo_genesis.evidence.recorder import git_record
from robo_genesis.pipeline.bundles.status import RECORDED_PAGE, bundle_status, cpu_runs
from robo_genesis.pipeline.command import Progress
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.recording.one_lab import Recording, found_backend, ready, record_lab
from robo_genesis.pipeline.recording.report import STATUS, Outcome, checkout, look, table

Runner = Callable[[Recording, Page, Progress], tuple[Path, Any]]


def record_all(recording: Recording, run: Runner = record_lab) -> int:
    """Record each lab that has no accepted bundle of this backend, and print a table of all.

    A lab that fails has its report printed at once, and the next one follows.

    Args:
        recording: see there.
        run: records one lab.

    Returns:
        The exit status: 0 every lab has a bundle, 1 some failed, 130 interrupted.

    Raises:
        RecordingError, BuildError, ProjectError: no lab can be recorded; see `recording.record`.
    """
    outcomes: list[Outcome] = []
    status = 0
    with ready(recording) as (labs, progress):
        backend = found_backend(recording, progress)
        for lesson, page in labs.items():
            one = replace(recording, lesson=lesson)
            if status == STATUS["interrupted"]:
                outcomes.append(Outcome(lesson, "not run"))
            else:
                outcomes.append(_outcome(one, page, backend, run, progress))
            status = max(status, STATUS[outcomes[-1].state])
    for line in table(outcomes, backend):
        recording.say(line)
    facts = [outcome.facts for outcome in outcomes if outcome.facts]
    for line in dict.fromkeys(checkout(fact.git) for fact in facts):
        recording.say(line)
    if facts:
        recording.say(f"Before you commit: {look(recording.evidence / '*' / backend)}")
    return status


def _kept(recording: Recording, backend: str, progress: Progress) -> Outcome | None:
    """Return the outcome of a lab whose bundle is accepted as it is, None if it needs a run."""
    place = recording.evidence / recording.lesson / backend
    status = bundle_status(
        place,
        recording.lesson,
        RECORDED_PAGE,
        book=recording.book,
        root=recording.root,
        cpu_runs=cpu_runs(place, {}),
    )
    if status.manifest is None:
        return None
    facts = status.manifest.predicate
    if facts.git and facts.git.dirty and (now := git_record()) and not now["dirty"]:
        return None  # a release refuses it, and now it can be recorded from a commit
    again = f"LESSON={recording.lesson} records it again"
    progress("keep", recording.lesson, f"{status.badge}, run {facts.run_id[:8]}; {again}")
    return Outcome(recording.lesson, "kept", str(place), facts)


def _outcome(
    recording: Recording, page: Page, backend: str, run: Runner, progress: Progress
) -> Outcome:
    """Return the outcome of a lab: its bundle is kept, or it is run."""
    begin = time.monotonic()
    try:
        if kept := _kept(recording, backend, progress):
            return kept
        place, facts = run(recording, page, progress)
        state, where = "recorded", str(place)
    except KeyboardInterrupt:
        state, where, facts = "interrupted", "the older bundle is unchanged", None
    except (ProjectError, BundleRefused, OSError) as error:
        recording.say(f"\n{error}\n")
        state, facts = "failed", None
        where = getattr(error, "reason", None) or (str(error) or type(error).__name__)
        where = where.splitlines()[0]
    return Outcome(recording.lesson, state, where, facts, time.monotonic() - begin)
