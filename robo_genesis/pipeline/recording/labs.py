"""`make evidence`: run labs on this machine, and keep the bundle of each whole, or not."""

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.files import put, settle_below
from robo_genesis.core.project import BACKEND, RENDER, ProjectError
from robo_genesis.core.text import printable
from robo_genesis.pipeline.bundles.status import RECORDED_PAGE, bundle_status
from robo_genesis.pipeline.command import Progress
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.kernels import users_variables
from robo_genesis.pipeline.stages import Build, build_lock, execute, prepare
from robo_genesis.sim import accelerator
from robo_genesis.sim.diagnosis import StepResult

ACCELERATORS = ("amdgpu", "cuda")
NO_COMMIT = (
    ". It names no commit, or a tree with changes, which a release refuses. Commit, then record "
    "it again with LESSON={}."
)


def probe_here(expected: str | None) -> tuple[str, list[StepResult]]:
    """Return the result of `accelerator.probe` with the variables that the kernel of a lab gets."""
    return accelerator.probe(accelerator.ProbedMachine(users_variables()), expected)


@dataclass(frozen=True, slots=True)
class Recording:
    """Which labs to record, and where their bundles go.

    `lesson` names one, and is empty for all. `expected` is the backend that must be
    found; None accepts any accelerator. `evidence` gets the folder `<lesson>/<actual
    backend>`. `probe` returns, before the run, the backend that it would find, and the
    results of its steps.
    """

    lesson: str
    expected: str | None
    evidence: Path
    build: Build
    probe: Callable[[str | None], tuple[str, list[StepResult]]] = probe_here


def record(recording: Recording) -> int:
    """Run labs in clean kernels, verify their bundles and put them in their places.

    Without a lesson, each lab that has no accepted bundle of this backend is run. A lab
    that fails has its report printed at once, and the next one follows. The last lines
    have the outcome of each lab. Pages see the requested backend and, always, a camera.

    Args:
        recording: see there.

    Returns:
        The exit status: 0 every lab has a bundle, 1 some failed, 130 interrupted. An
        older bundle is unchanged unless a new one is accepted.

    Raises:
        ProjectError: the lesson is not valid, or a step of the probe is broken; or
            checkout, environment or the folder of bundles is not fit for it, or a build
            or another recording runs here.
    """
    build, status = recording.build, 0
    store = build.cache / project.RECORDING
    os.environ[BACKEND] = "cpu" if recording.expected == "cpu" else "auto"
    os.environ[RENDER] = "1"
    with build_lock(build.cache):
        settle_below(recording.evidence)
        recording.evidence.mkdir(parents=True, exist_ok=True)  # before hours of work
        _, pages, into = prepare(build, project.RECORDING)
        labs, progress = _labs(recording, pages), Progress(build.say)
        backend = _found_backend(recording, progress)
        outcomes = dict.fromkeys(labs, "not recorded")
        try:
            for lesson, page in labs.items():
                shutil.rmtree(store, ignore_errors=True)
                try:
                    kept = _kept(recording, lesson, backend)
                    done = kept or _record_lab(recording, page, into, progress)
                except (ProjectError, OSError) as error:
                    build.say(f"\n{error}\n")
                    done, status = "failed", 1
                progress("record", lesson, done)
                outcomes[lesson] = done
        except KeyboardInterrupt:
            status = 130
        shutil.rmtree(store, ignore_errors=True)
    for lesson, outcome in outcomes.items():
        build.say(f"{lesson}  {outcome}")
    build.say(
        f"Before you commit: look at both pictures in {recording.evidence}/*/{backend}/frames, "
        "read log.txt, and check that manifest.json names nothing private of your machine."
    )
    return status


def _labs(recording: Recording, pages: list[Page]) -> dict[str, Page]:
    """Return the lab of the given lesson, or all labs by lesson in the order of the book.

    Raises:
        ProjectError: the lesson has no lab.
    """
    labs = {str(page.lesson): page for page in pages if page.page == RECORDED_PAGE}
    asked = recording.lesson
    if asked and asked not in labs:
        raise ProjectError(
            f"LESSON={asked!r} is not valid. "
            f"Lessons with a lab: {', '.join(sorted(labs)) or 'none'}; unset, all."
        )
    return {asked: labs[asked]} if asked else labs


def _found_backend(recording: Recording, progress: Progress) -> str:
    """Return the backend that a run would find, after a probe of the accelerator.

    Raises:
        ProjectError: a step of the probe is broken.
    """
    if recording.expected == "cpu":
        return "cpu"
    found, steps = recording.probe(recording.expected)
    for step in steps:
        progress("probe", f"{step.step:12} {step.state:8} {printable(step.found)}")
    if broken := [step.step for step in steps if step.state == "broken"]:
        raise ProjectError(
            f"Broken: {', '.join(broken)}. The lines of the probe above say what was found, what "
            "is expected and what to do. No lab was run."
        )
    return found


def _kept(recording: Recording, lesson: str, backend: str) -> str:
    """Return words on the accepted bundle of this backend, none if the lab is to be run."""
    if recording.lesson:
        return ""
    place = recording.evidence / lesson / backend
    kept = bundle_status(place, lesson, RECORDED_PAGE, book=recording.build.book)
    again = f"kept: {place}, {kept.badge}; LESSON={lesson} records it again"
    return again if kept.manifest else ""


def _record_lab(
    recording: Recording, page: Page, into: dict[str, Path], progress: Progress
) -> str:
    """Run one lab, put its verified bundle into its place, and return words on it.

    Raises:
        ProjectError: see `record`.
    """
    [result], manifests = execute(recording.build, [page], into, progress)
    manifest, lesson = manifests[page.docname], str(page.lesson)
    actual = manifest.backend.actual
    expected = (recording.expected,) if recording.expected else ACCELERATORS
    if actual not in expected:
        raise ProjectError(
            f"Expected backend: {' or '.join(expected)}; found {actual!r}. Check driver, device "
            f"and Torch build, or record {actual} on purpose with BACKEND={actual}."
        )
    place = recording.evidence / lesson / actual
    assert result.bundle is not None  # a lab without a bundle has failed
    put(result.bundle, place)
    facts = f"{manifest.passed} checks, {manifest.backend.device_name}"
    words = printable(f"recorded: {place}, {facts}")
    unclean = manifest.git is None or manifest.git.dirty
    return words + NO_COMMIT.format(lesson) * unclean
