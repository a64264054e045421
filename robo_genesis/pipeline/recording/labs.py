"""`make evidence`: run labs on this machine, and keep the bundle of each whole, or not."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.files import (
    put,
    settle_below,
)
from robo_genesis.core.git import require_history
from robo_genesis.core.project import BACKEND, RENDER
from robo_genesis.core.text import printable
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles.page_bundles import (
    outputs_compared,
    require_contract,
)
from robo_genesis.pipeline.bundles.status import RECORDED_PAGE, bundle_status
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.command import TIMEOUT, Progress, say
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.execute import Lines, execute_pages, kernel_environment
from robo_genesis.pipeline.pages.kernels import users_variables
from robo_genesis.pipeline.pages.results import failure_report
from robo_genesis.pipeline.pages.store import Verify, places
from robo_genesis.pipeline.recording.report import STATUS, Outcome, report
from robo_genesis.pipeline.stages import build_lock
from robo_genesis.sim import accelerator
from robo_genesis.sim.diagnosis import StepResult

ACCELERATORS = ("amdgpu", "cuda")
COMMAND = "make evidence"


def probe_here(expected: str | None) -> tuple[str, list[StepResult]]:
    """Return the result of `accelerator.probe` with the variables that the kernel of a lab gets."""
    return accelerator.probe(accelerator.ProbedMachine(users_variables()), expected)


@dataclass(frozen=True, slots=True)
class Recording:
    """Which labs to record, and where their bundles go.

    `lesson` names one, and is empty for all. `expected` is the backend that must be
    found; None accepts any accelerator. `to` gets the folder `<lesson>/<actual
    backend>`; None is the book's own `evidence`. `probe` returns, before the run, the
    backend that it would find, and the results of its steps.
    """

    lesson: str = ""
    expected: str | None = None
    to: Path | None = None
    root: Path = project.ROOT
    book: Path = project.BOOK
    cache: Path = project.CACHE
    timeout: int = TIMEOUT
    verify: Verify = verify_bundle
    probe: Callable[[str | None], tuple[str, list[StepResult]]] = probe_here
    say: Callable[[str], None] = say

    @property
    def evidence(self) -> Path:
        """The folder of all recorded bundles."""
        return self.to or self.book / "evidence"

    @property
    def contract(self) -> dict[str, str]:
        """The variables that request a lab's backend and, always, its camera."""
        return {BACKEND: "cpu" if self.expected == "cpu" else "auto", RENDER: "1"}


def record(recording: Recording) -> int:
    """Run labs in clean kernels, verify their bundles and put them in their places; print a table.

    Without a lesson, each lab that has no accepted bundle of this backend is run. A lab
    that fails has its report printed at once, and the next one follows.

    Args:
        recording: see there.

    Returns:
        The exit status: 0 every lab has a bundle, 1 some failed, 130 interrupted. An
            older bundle
        is unchanged unless a new one is accepted.

    Raises:
        ProjectError: the lesson is not valid, or a step of the probe is broken.
        ProjectError: checkout, environment or the folder of bundles is not fit for it,
            or a build or another recording runs here.
    """
    with build_lock(recording.cache):
        settle_below(recording.evidence)
        recording.evidence.mkdir(parents=True, exist_ok=True)  # before hours of work
        require_history(recording.root)
        project.require_pinned_engine(recording.root)
        labs, progress = _labs(recording), Progress(recording.say)
        backend = _found_backend(recording, progress)
        outcomes = list[Outcome]()
        for page in labs:
            outcomes.append(_outcome(recording, page, backend, progress))
            if outcomes[-1].state == "interrupted":
                break
    recording.say("\n".join(report(outcomes, backend, recording.evidence)))
    return max((STATUS[outcome.state] for outcome in outcomes), default=0)


def _labs(recording: Recording) -> list[Page]:
    """Return the lab of the given lesson, or all labs in the order of the book.

    Raises:
        ProjectError: the lesson has no lab.
    """
    pages = find_pages(recording.book)
    labs = {str(page.lesson): page for page in pages if page.page == RECORDED_PAGE}
    if not recording.lesson:
        return [*labs.values()]
    if recording.lesson not in labs:
        raise project.ProjectError(
            f"LESSON={recording.lesson!r} is not valid. "
            f"Lessons with a lab: {', '.join(sorted(labs)) or 'none'}; unset, all."
        )
    return [labs[recording.lesson]]


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
        raise project.ProjectError(
            f"Broken: {', '.join(broken)}. The lines of the probe above say what was found, what "
            "is expected and what to do. No lab was run."
        )
    return found


def _outcome(
    recording: Recording, page: Page, backend: str, progress: Progress
) -> Outcome:
    """Return the outcome of a lab: its accepted bundle is kept, or it is run."""
    lesson = str(page.lesson)
    place = recording.evidence / lesson / backend
    if not recording.lesson:
        kept = bundle_status(
            place, lesson, RECORDED_PAGE, book=recording.book, root=recording.root
        )
        if kept.manifest:
            progress("keep", lesson, f"{kept.badge}; LESSON={lesson} records it again")
            return Outcome(lesson, "kept", str(place), kept.manifest)
    manifest = None
    try:
        place, manifest = record_lab(recording, page, progress)
        state, where = "recorded", str(place)
    except KeyboardInterrupt:
        state, where = "interrupted", "the older bundle is unchanged"
    except (project.ProjectError, BundleRefused, OSError) as error:
        recording.say(f"\n{error}\n")
        state, where = "failed", str(error).partition("\n")[0]
    return Outcome(lesson, state, where, manifest)


def record_lab(
    recording: Recording, page: Page, progress: Progress
) -> tuple[Path, Any]:
    """Run one lab, and return the place of its verified bundle and the facts in its manifest.

    Raises:
        ProjectError: see `record`.
    """
    project.remove_stale_kernel_lock(recording.cache)
    # New each time: nothing is ever reused.
    folder = recording.cache / project.RECORDING
    shutil.rmtree(folder, ignore_errors=True)
    try:
        bundle, facts = _run(recording, page, folder, progress)
        place = recording.evidence / str(page.lesson) / bundle.name
        put(bundle, place)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    progress("record", str(place))
    return place, facts


def _run(
    recording: Recording, page: Page, folder: Path, progress: Progress
) -> tuple[Path, Any]:
    """Run the lab in a clean kernel; return its bundle, and what its manifest says, verified."""
    contract = recording.contract
    progress("execute", page.docname, f"{BACKEND}={contract[BACKEND]}")
    environment = kernel_environment(
        recording.root, recording.cache, COMMAND, **contract
    )
    [result] = execute_pages(
        [page],
        places([page], folder, recording.root, environment),
        timeout=recording.timeout,
        environment=environment,
        logs=recording.cache / project.LOGS,
        report=Lines(partial(progress, "execute")),
    )
    if result.failure:
        raise project.ProjectError(f"{result.failure}\n\n{failure_report([result])}")
    assert result.bundle is not None  # a lab without a bundle has failed
    try:
        manifest = recording.verify(result.bundle)
        require_contract(manifest, contract)
        outputs_compared(result, manifest)
    except BundleRefused as error:
        raise project.ProjectError(
            f"The bundle of this run is refused: {error}"
        ) from error
    require_expected(recording, manifest.backend.actual)
    progress("verify", page.docname, "accepted")
    return result.bundle, manifest


def require_expected(recording: Recording, actual: str) -> None:
    """Raise ProjectError if the backend found is not the expected one."""
    expected = (recording.expected,) if recording.expected else ACCELERATORS
    if actual not in expected:
        raise project.ProjectError(
            f"Expected backend: {' or '.join(expected)}; found {actual!r}. Check driver, device "
            f"and Torch build, or record {actual} on purpose with BACKEND={actual}."
        )
