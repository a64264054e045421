"""`make evidence`: run a lesson's lab on this machine and keep its bundle, whole or not at all."""

import os
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robo_genesis.build.backend_probe import foreseen_backend
from robo_genesis.build.execute import TIMEOUT, execute_pages
from robo_genesis.build.page_results import PageResult, failure_report
from robo_genesis.build.stages import Progress, Verify, only_build
from robo_genesis.core import project
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.bundle_store import put, recover, require_folder
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.lessons.book_pages import Page, find_pages

ACCELERATORS = ("amdgpu", "cuda")
BACKENDS = (*ACCELERATORS, "cpu")
COMMAND = "make evidence"


class RecordingError(Exception):
    """Nothing was recorded; the message is the whole report. What stood before still stands."""


@dataclass(frozen=True, slots=True)
class Recording:
    """Which lab to record, and where its bundle goes.

    `expected` is the backend that must be found; None stands for any accelerator. `to` holds
    `<lesson>/<actual backend>`; None is the book's own `evidence`. `verify` takes a bundle folder
    and its run id, returns the manifest or raises; None is the course's own verification.
    `foresee` tells before the run which backend it would find.
    """

    lesson: str
    expected: str | None = None
    to: Path | None = None
    root: Path = project.ROOT
    book: Path = project.BOOK
    cache: Path = project.CACHE
    timeout: int = TIMEOUT
    verify: Verify | None = None
    foresee: Callable[[], str] | None = None
    say: Callable[[str], None] = print

    @property
    def evidence(self) -> Path:
        """The folder of all recorded bundles."""
        return self.to or self.book / "evidence"

    @property
    def requested(self) -> str:
        """What the lab is told in ROBO_GENESIS_BACKEND."""
        return "cpu" if self.expected == "cpu" else "auto"


def record(recording: Recording) -> list[str]:
    """Run the lab in a clean kernel, verify its bundle and put it in its place.

    Args:
        recording: see there.

    Returns:
        The last lines for the user: what stands where, and what to look at before a commit.

    Raises:
        RecordingError: the lesson or backend is not valid, another backend was found, the lab
            failed, or its bundle was refused. What was recorded before still stands.
        BuildError: a build, or another recording, runs here.
        ProjectError, PageError: checkout, environment or the bundle's place is not fit for it.
    """
    with only_build(recording.cache):
        recover(recording.evidence)
        page, progress = _lab(recording), Progress(recording.say)
        require_folder(recording.evidence)
        project.require_pinned_engine(recording.root)
        if recording.requested == "auto":
            found = (recording.foresee or foreseen_backend)()
            progress("probe", f"Torch sees {found}")
            require_expected(recording, found)
        place, facts = _run(recording, page, progress)
        return summary(place, facts)


def _run(recording: Recording, page: Page, progress: Progress) -> tuple[Path, Any]:
    """Execute, verify and put in place; return where the bundle stands and what it says."""
    project.remove_stale_kernel_lock(recording.cache)
    folder = recording.cache / "recording"  # new each time: nothing is ever reused
    shutil.rmtree(folder, ignore_errors=True)
    try:
        result = _execute(recording, page, folder, progress)
        bundle, facts = _accepted(recording, result, progress)
        place = put(bundle, recording.evidence / recording.lesson)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    progress("record", str(place))
    return place, facts


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
    """Raise RecordingError where the backend found is not the one that was expected."""
    valid = ACCELERATORS if recording.expected is None else (recording.expected,)
    if actual in valid:
        return
    asked = recording.expected or f"none given, so one of {', '.join(ACCELERATORS)}"
    mend = "Check driver, device and Torch build"
    if actual in BACKENDS:
        mend += f", or record {actual} on purpose with BACKEND={actual}"
    raise RecordingError(
        f"Expected backend: {asked}; ROBO_GENESIS_BACKEND={recording.requested} finds {actual!r}. "
        f"Nothing is relabelled. {mend}."
    )


def _execute(recording: Recording, page: Page, folder: Path, progress: Progress) -> PageResult:
    """Run the lab in a clean kernel and return what came of it."""
    progress("execute", page.docname, f"ROBO_GENESIS_BACKEND={recording.requested}")
    [result] = execute_pages(
        [page],
        folder,
        timeout=recording.timeout,
        environment=kernel_environment(recording),
        on_progress=lambda what, event: progress("execute", what, event),
    )
    if result.failure:
        raise RecordingError(failure_report([result]))
    return result


def kernel_environment(recording: Recording) -> dict[str, str]:
    """Return the variables that the lab's kernel gets; a recording always uses the camera."""
    asked = {"ROBO_GENESIS_BACKEND": recording.requested, "ROBO_GENESIS_RENDER": "1"}
    return {
        **project.engine_cache_environment(recording.root, recording.cache),
        **project.environment_contract({**os.environ, **asked}),
        "ROBO_GENESIS_COMMAND": COMMAND,
    }


def _accepted(recording: Recording, result: PageResult, progress: Progress) -> tuple[Path, Any]:
    """Return a bundle that is verified and of the run that was asked for, and what it says."""
    if result.bundle is None:
        raise RecordingError(f"{result.page.docname} left no bundle.")
    require_expected(recording, result.bundle.name)
    try:
        manifest = (recording.verify or verify_bundle)(result.bundle, result.run_id)
    except BundleRefused as error:
        raise RecordingError(f"The bundle of this run is refused: {error}") from error
    facts = manifest.predicate
    require_expected(recording, facts.backend.actual)
    asked = {"backend.requested": recording.requested, "render.mode": "camera", "command": COMMAND}
    found = dict(
        zip(asked, (facts.backend.requested, facts.render.mode, facts.command), strict=True)
    )
    if found != asked:
        raise RecordingError(
            f"The bundle says {found}, this recording asked for {asked}. Let the page read "
            "runtime.read_contract() and set nothing of it itself."
        )
    progress("verify", result.page.docname, "accepted")
    return result.bundle, facts


def summary(place: Path, facts: Any) -> list[str]:
    """Return what a recording ends with: the facts of the run, and what to check by eye.

    Args:
        place: where the bundle stands.
        facts: what its manifest says of the run.
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
        *_checkout(facts.git),
        f"Before you commit: look at both pictures in {place / 'frames'}, read log.txt, and see "
        "that manifest.json names nothing of your machine that is private.",
    ]


def _checkout(git: Any) -> Sequence[str]:
    """Return a line for a checkout that does not say exactly which sources ran."""
    if git is None:
        return ["Checkout: no git here, so no commit is recorded; a release refuses that."]
    if git.dirty:
        return [
            f"Checkout: changed since commit {git.commit[:12]}, and the manifest says so; a "
            "release refuses that. Commit or stash, then record again."
        ]
    return [f"Checkout: clean, commit {git.commit[:12]}"]
