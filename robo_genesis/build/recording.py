"""`make evidence`: run a lesson's lab on this machine and keep its bundle, whole or not at all."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.build.backend_probe import expected_backend
from robo_genesis.build.command import TIMEOUT, Progress, say
from robo_genesis.build.execute import execute_pages, kernel_environment
from robo_genesis.build.page_progress import reporting
from robo_genesis.build.page_results import PageResult, failure_report
from robo_genesis.build.page_store import Verify, places
from robo_genesis.build.stages import build_lock
from robo_genesis.build.verification import require_contract
from robo_genesis.core import project
from robo_genesis.core.project import BACKEND, RENDER
from robo_genesis.core.refusals import BundleRefused, expect
from robo_genesis.evidence.bundle_store import put, recover, require_folder
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.lessons.book_pages import Page, find_pages

ACCELERATORS = ("amdgpu", "cuda")
BACKENDS = (*ACCELERATORS, "cpu")
COMMAND = "make evidence"


class RecordingError(project.ProjectError):
    """Nothing was recorded; the message is the whole report. The older bundle is unchanged."""


@dataclass(frozen=True, slots=True)
class Recording:
    """Which lab to record, and where its bundle goes.

    `expected` is the backend that must be found; None accepts any accelerator. `to` gets the folder
    `<lesson>/<actual backend>`; None is the book's own `evidence`. `probe` returns, before the run,
    the backend that it would find.
    """

    lesson: str
    expected: str | None = None
    to: Path | None = None
    root: Path = project.ROOT
    book: Path = project.BOOK
    cache: Path = project.CACHE
    timeout: int = TIMEOUT
    verify: Verify = verify_bundle
    probe: Callable[[], str] = expected_backend
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
    """Run the lab in a clean kernel, verify its bundle and put it in its place.

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
    with build_lock(recording.cache):
        recover(recording.evidence)
        page, progress = _lab(recording), Progress(recording.say)
        require_folder(recording.evidence)
        project.require_pinned_engine(recording.root)
        if recording.requested == "auto":
            found = recording.probe()
            progress("probe", f"Torch finds {found}")
            require_expected(recording, found)
        project.remove_stale_kernel_lock(recording.cache)
        folder = recording.cache / project.RECORDING  # new each time: nothing is ever reused
        shutil.rmtree(folder, ignore_errors=True)
        try:
            result = _execute(recording, page, folder, progress)
            bundle, facts = _accepted(recording, result)
            progress("verify", page.docname, "accepted")
            place = put(bundle, recording.evidence / recording.lesson)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        progress("record", str(place))
        return summary(place, facts)


def _lab(recording: Recording) -> Page:
    """Return the lab page of the lesson, after checking both names that the user gave."""
    if recording.expected not in (None, *BACKENDS):
        raise RecordingError(
            f"BACKEND={recording.expected!r} is not valid. Choices: {', '.join(BACKENDS)}; "
            "unset, any accelerator."
        )
    labs = {str(page.lesson): page for page in find_pages(recording.book) if page.page == "lab"}
    if recording.lesson not in labs:
        raise RecordingError(
            f"LESSON={recording.lesson!r} is not valid. "
            f"Lessons with a lab: {', '.join(sorted(labs)) or 'none'}."
        )
    return labs[recording.lesson]


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
    if result.failure:
        raise RecordingError(failure_report([result]))
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
        _checkout(facts.git),
        f"Before you commit: look at both pictures in {place / 'frames'}, read log.txt, and check "
        "that manifest.json names nothing private of your machine.",
    ]


def _checkout(git: Any) -> str:
    """Return a line that says which sources ran."""
    if git is None:
        return "Checkout: no git here, so no commit is recorded; a release refuses that."
    if git.dirty:
        return (
            f"Checkout: changed since commit {git.commit[:12]}, and the manifest says so; a "
            "release refuses that. Commit or stash, then record again."
        )
    return f"Checkout: clean, commit {git.commit[:12]}"
