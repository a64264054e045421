"""`make evidence LESSON=l04`: run a lab on this machine and keep its bundle whole, or not."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.project import BACKEND, RENDER
from robo_genesis.core.refusals import BundleRefused, expect
from robo_genesis.evidence.bundle_store import put, recover, require_folder
from robo_genesis.pipeline.bundles.of_build import require_contract
from robo_genesis.pipeline.bundles.status import RECORDED_PAGE
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.command import TIMEOUT, Progress, say
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.execute import execute_pages, kernel_environment
from robo_genesis.pipeline.pages.progress import reporting
from robo_genesis.pipeline.pages.results import PageResult, failure_report
from robo_genesis.pipeline.pages.store import Verify, places
from robo_genesis.pipeline.recording.backend_probe import probe
from robo_genesis.pipeline.recording.report import summary
from robo_genesis.pipeline.stages import build_lock
from robo_genesis.sim.diagnosis import Finding

ACCELERATORS = ("amdgpu", "cuda")
BACKENDS = (*ACCELERATORS, "cpu")
COMMAND = "make evidence"


class RecordingError(project.ProjectError):
    """Nothing was recorded; the message is the whole report. The older bundle is unchanged.

    `reason` is its first line, or the error of a page that failed.
    """

    def __init__(self, report: str, reason: str = "") -> None:
        super().__init__(report)
        self.reason = (reason or report).splitlines()[0]


@dataclass(frozen=True, slots=True)
class Recording:
    """Which labs to record, and where their bundles go.

    `lesson` names one, and is empty for all. `expected` is the backend that must be found; None
    accepts any accelerator. `to` gets the folder `<lesson>/<actual backend>`; None is the book's
    own `evidence`. `probe` returns, before the run, the backend that it would find, and the
    findings of its steps.
    """

    lesson: str
    expected: str | None = None
    to: Path | None = None
    root: Path = project.ROOT
    book: Path = project.BOOK
    cache: Path = project.CACHE
    timeout: int = TIMEOUT
    verify: Verify = verify_bundle
    probe: Callable[[str | None], tuple[str, list[Finding]]] = probe
    say: Callable[[str], None] = say

    @property
    def evidence(self) -> Path:
        """The folder of all recorded bundles."""
        return self.to or self.book / "evidence"

    @property
    def requested(self) -> str:
        """The lab's requested backend."""
        return "cpu" if self.expected == "cpu" else "auto"


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
    with ready(recording) as (pages, progress):
        if recording.lesson not in pages:
            raise RecordingError(
                f"LESSON={recording.lesson!r} is not valid. "
                f"Lessons with a lab: {', '.join(sorted(pages)) or 'none'}; unset, all."
            )
        found_backend(recording, progress)
        return summary(*record_lab(recording, pages[recording.lesson], progress))


@contextmanager
def ready(recording: Recording) -> Iterator[tuple[dict[str, Page], Progress]]:
    """Hold the lock of builds, and check before any run what does not depend on the lab.

    Yields:
        The labs by their lessons, and the lines of progress.
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
        yield labs, Progress(recording.say)


def found_backend(recording: Recording, progress: Progress) -> str:
    """Return the backend that a run would find, after a probe of the accelerator.

    Raises:
        RecordingError: a step of the probe is broken.
    """
    if recording.requested == "cpu":
        return "cpu"
    found, findings = recording.probe(recording.expected)
    for finding in findings:
        progress("probe", f"{finding.step:12} {finding.state:8} {finding.found}")
    broken = [finding.step for finding in findings if finding.state == "broken"]
    if broken:
        raise RecordingError(
            f"Broken: {', '.join(broken)}. The lines of the probe above say what was found, what "
            "is expected and what to do. No lab was run."
        )
    return found


def record_lab(recording: Recording, page: Page, progress: Progress) -> tuple[Path, Any]:
    """Run one lab, and return the place of its verified bundle and the facts in its manifest.

    Raises:
        RecordingError, ProjectError: see `record`.
    """
    project.remove_stale_kernel_lock(recording.cache)
    folder = recording.cache / project.RECORDING  # new each time: nothing is ever reused
    shutil.rmtree(folder, ignore_errors=True)
    try:
        result = _execute(recording, page, folder, progress)
        bundle, facts = _accepted(recording, result)
        progress("verify", page.docname, "accepted")
        place = put(bundle, recording.evidence / str(page.lesson))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    progress("record", str(place))
    return place, facts


def require_expected(recording: Recording, actual: str) -> None:
    """Raise RecordingError if the backend found is not the expected one."""
    valid = ACCELERATORS if recording.expected is None else (recording.expected,)
    if actual in valid:
        return
    expected = recording.expected or f"none given, so one of {', '.join(ACCELERATORS)}"
    remedy = "Check driver, device and Torch build"
    if actual in BACKENDS:
        remedy += f", or record {actual} on purpose with BACKEND={actual}"
    raise RecordingError(
        f"Expected backend: {expected}; {BACKEND}={recording.requested} finds "
        f"{actual!r}. Nothing is relabelled. {remedy}."
    )


def contract(recording: Recording) -> dict[str, str]:
    """Return the variables that request the lab's backend and, always, its camera."""
    return {BACKEND: recording.requested, RENDER: "1"}


def _execute(recording: Recording, page: Page, folder: Path, progress: Progress) -> PageResult:
    """Run the lab in a clean kernel and return the result."""
    progress("execute", page.docname, f"{BACKEND}={recording.requested}")
    environment = kernel_environment(
        recording.root, recording.cache, COMMAND, **contract(recording)
    )
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
    return result


def _accepted(recording: Recording, result: PageResult) -> tuple[Path, Any]:
    """Return a verified bundle of the requested run, and what its manifest says."""
    assert result.bundle is not None  # a lab without a bundle has failed
    require_expected(recording, result.bundle.name)
    try:
        facts = recording.verify(result.bundle, result.run_id).predicate
        require_contract(facts, contract(recording))
        expect("command", "manifest.json", "command", facts.command, COMMAND)
    except BundleRefused as error:
        raise RecordingError(f"The bundle of this run is refused: {error}") from error
    require_expected(recording, facts.backend.actual)
    return result.bundle, facts
