"""`make evidence`: run labs on this machine, and keep the bundle of each whole, or not."""

import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.project import BACKEND, RENDER
from robo_genesis.core.text import printable
from robo_genesis.evidence.bundle_store import put, recover, require_folder
from robo_genesis.evidence.recorder import git_record
from robo_genesis.evidence.refusals import BundleRefused, expect
from robo_genesis.pipeline.bundles.of_build import require_contract
from robo_genesis.pipeline.bundles.status import RECORDED_PAGE, bundle_status, cpu_runs
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.command import TIMEOUT, Progress, say
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.execute import execute_pages, kernel_environment
from robo_genesis.pipeline.pages.kernels import users_variables
from robo_genesis.pipeline.pages.progress import reporting
from robo_genesis.pipeline.pages.results import failure_report
from robo_genesis.pipeline.pages.store import Verify, places
from robo_genesis.pipeline.recording.report import STATUS, Outcome, checkout, look, summary, table
from robo_genesis.pipeline.stages import build_lock
from robo_genesis.sim import accelerator
from robo_genesis.sim.diagnosis import StepResult

ACCELERATORS = ("amdgpu", "cuda")
BACKENDS = (*ACCELERATORS, "cpu")
COMMAND = "make evidence"


class RecordingError(project.ProjectError):
    """Nothing was recorded; the message is the whole report. The older bundle is unchanged.

    `reason` is its first line, or the error of a page that failed.
    """

    def __init__(self, report: str, reason: str = "") -> None:
        super().__init__(report)
        self.reason = reason or report


def probe_here(expected: str | None) -> tuple[str, list[StepResult]]:
    """Return the result of `accelerator.probe` with the variables that the kernel of a lab gets."""
    return accelerator.probe(accelerator.ProbedMachine(users_variables()), expected)


@dataclass(frozen=True, slots=True)
class Recording:
    """Which labs to record, and where their bundles go.

    `lesson` names one, and is empty for all. `expected` is the backend that must be found; None
    accepts any accelerator. `to` gets the folder `<lesson>/<actual backend>`; None is the book's
    own `evidence`. `probe` returns, before the run, the backend that it would find, and the
    results of its steps.
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


Runner = Callable[[Recording, Page, Progress], tuple[Path, Any]]


def record(recording: Recording) -> list[str]:
    """Run one lab in a clean kernel, verify its bundle and put it in its place.

    Args:
        recording: see there.

    Returns:
        The last lines for the user: where the bundle is, and what to look at before a commit.

    Raises:
        RecordingError: the lesson or backend is not valid, another backend was found, the lab
            failed, or its bundle was refused. The older bundle is unchanged.
        BuildError: a build, or another recording, runs here.
        ProjectError: checkout, environment or the bundle's place is not fit for it.
    """
    with _ready(recording) as (labs, _, progress):
        return summary(*record_lab(recording, labs[recording.lesson], progress))


def record_all(recording: Recording, run: Runner | None = None) -> int:
    """Record each lab that has no accepted bundle of this backend, and print a table of all.

    A lab that fails has its report printed at once, and the next one follows.

    Args:
        recording: see there.
        run: records one lab, by default `record_lab`.

    Returns:
        The exit status: 0 every lab has a bundle, 1 some failed, 130 interrupted.

    Raises:
        RecordingError, BuildError, ProjectError: no lab can be recorded; see `record`.
    """
    outcomes: list[Outcome] = []
    with _ready(recording) as (labs, backend, progress):
        for lesson, page in labs.items():
            if any(one.state == "interrupted" for one in outcomes):
                outcomes.append(Outcome(lesson, "not run"))
            else:
                outcomes.append(_outcome(recording, page, backend, run or record_lab, progress))
    facts = [outcome.facts for outcome in outcomes if outcome.facts]
    lines = [*table(outcomes, backend), *dict.fromkeys(checkout(fact.git) for fact in facts)]
    if facts:
        lines.append(f"Before you commit: {look(recording.evidence / '*' / backend)}")
    for line in lines:
        recording.say(line)
    return max((STATUS[outcome.state] for outcome in outcomes), default=0)


@contextmanager
def _ready(recording: Recording) -> Iterator[tuple[dict[str, Page], str, Progress]]:
    """Hold the lock of builds, and check before any run what does not depend on the lab.

    Yields:
        The labs by their lessons, the backend that a run would find, and the lines of progress.
    """
    if recording.expected not in (None, *BACKENDS):
        raise RecordingError(
            f"BACKEND={recording.expected!r} is not valid. Choices: {', '.join(BACKENDS)}; "
            "unset, any accelerator."
        )
    with build_lock(recording.cache):
        recover(recording.evidence)
        require_folder(recording.evidence)
        project.require_pinned_engine(recording.root)
        pages = find_pages(recording.book)
        labs = {str(page.lesson): page for page in pages if page.page == RECORDED_PAGE}
        if recording.lesson and recording.lesson not in labs:
            raise RecordingError(
                f"LESSON={recording.lesson!r} is not valid. "
                f"Lessons with a lab: {', '.join(sorted(labs)) or 'none'}; unset, all."
            )
        progress = Progress(recording.say)
        yield labs, _found_backend(recording, progress), progress


def _found_backend(recording: Recording, progress: Progress) -> str:
    """Return the backend that a run would find, after a probe of the accelerator.

    Raises:
        RecordingError: a step of the probe is broken.
    """
    if recording.expected == "cpu":
        return "cpu"
    found, steps = recording.probe(recording.expected)
    for step in steps:
        progress("probe", f"{step.step:12} {step.state:8} {printable(step.found)}")
    if broken := [step.step for step in steps if step.state == "broken"]:
        raise RecordingError(
            f"Broken: {', '.join(broken)}. The lines of the probe above say what was found, what "
            "is expected and what to do. No lab was run."
        )
    return found


def _kept(recording: Recording, lesson: str, backend: str, progress: Progress) -> Outcome | None:
    """Return the outcome of a lab whose bundle is accepted as it is, None if it needs a run."""
    place = recording.evidence / lesson / backend
    runs, book, root = cpu_runs(place, {}), recording.book, recording.root
    status = bundle_status(place, lesson, RECORDED_PAGE, book=book, root=root, cpu_runs=runs)
    if status.manifest is None:
        return None
    facts = status.manifest.predicate
    if facts.git and facts.git.dirty and (now := git_record()) and not now["dirty"]:
        return None  # a release refuses it, and now it can be recorded from a commit
    again = f"LESSON={lesson} records it again"
    progress("keep", lesson, f"{status.badge}, run {facts.run_id[:8]}; {again}")
    return Outcome(lesson, "kept", str(place), facts)


def _outcome(
    recording: Recording, page: Page, backend: str, run: Runner, progress: Progress
) -> Outcome:
    """Return the outcome of a lab: its bundle is kept, or it is run."""
    begin, facts = time.monotonic(), None
    try:
        if kept := _kept(recording, str(page.lesson), backend, progress):
            return kept
        place, facts = run(recording, page, progress)
        state, where = "recorded", str(place)
    except KeyboardInterrupt:
        state, where = "interrupted", "the older bundle is unchanged"
    except (project.ProjectError, BundleRefused, OSError) as error:
        recording.say(f"\n{error}\n")
        reason = getattr(error, "reason", None) or str(error) or type(error).__name__
        state, where = "failed", reason.splitlines()[0]
    return Outcome(str(page.lesson), state, where, facts, time.monotonic() - begin)


def record_lab(recording: Recording, page: Page, progress: Progress) -> tuple[Path, Any]:
    """Run one lab, and return the place of its verified bundle and the facts in its manifest.

    Raises:
        RecordingError, ProjectError: see `record`.
    """
    project.remove_stale_kernel_lock(recording.cache)
    folder = recording.cache / project.RECORDING  # new each time: nothing is ever reused
    shutil.rmtree(folder, ignore_errors=True)
    try:
        bundle, run_id = _execute(recording, page, folder, progress)
        facts = _accepted(recording, bundle, run_id)
        progress("verify", page.docname, "accepted")
        place = put(bundle, recording.evidence / str(page.lesson))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    progress("record", str(place))
    return place, facts


def _execute(
    recording: Recording, page: Page, folder: Path, progress: Progress
) -> tuple[Path, str]:
    """Run the lab in a clean kernel; return the folder of its bundle and the id of the run."""
    contract = recording.contract
    progress("execute", page.docname, f"{BACKEND}={contract[BACKEND]}")
    environment = kernel_environment(recording.root, recording.cache, COMMAND, **contract)
    with reporting(progress) as report:
        [result] = execute_pages(
            [page],
            places([page], folder, recording.root, environment),
            timeout=recording.timeout,
            environment=environment,
            logs=recording.cache / project.LOGS,
            report=report,
        )
    if failure := result.failure:
        reason = f"{failure.error}: {failure.message}"
        raise RecordingError(failure_report([result]), reason)
    assert result.bundle is not None  # a lab without a bundle has failed
    return result.bundle, result.run_id


def _accepted(recording: Recording, bundle: Path, run_id: str) -> Any:
    """Return what the manifest of a bundle says, after verifying that it is the requested run's."""
    require_expected(recording, bundle.name)
    try:
        facts = recording.verify(bundle, run_id).predicate
        require_contract(facts, recording.contract)
        expect("command", "manifest.json", "command", facts.command, COMMAND)
    except BundleRefused as error:
        raise RecordingError(f"The bundle of this run is refused: {error}") from error
    require_expected(recording, facts.backend.actual)
    return facts


def require_expected(recording: Recording, actual: str) -> None:
    """Raise RecordingError if the backend found is not the expected one."""
    if actual in (ACCELERATORS if recording.expected is None else (recording.expected,)):
        return
    expected = recording.expected or f"none given, so one of {', '.join(ACCELERATORS)}"
    remedy = "Check driver, device and Torch build"
    if actual in BACKENDS:
        remedy += f", or record {actual} on purpose with BACKEND={actual}"
    raise RecordingError(
        f"Expected backend: {expected}; {BACKEND}={recording.contract[BACKEND]} finds "
        f"{actual!r}. Nothing is relabelled. {remedy}."
    )
