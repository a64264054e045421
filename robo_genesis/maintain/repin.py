"""The steps of `make repin`: try another engine version in a worktree, then change pin and lock.

Nothing of the checkout is touched before the last step, which writes two files.
"""

import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.files import locked
from robo_genesis.core.git import git, unclean
from robo_genesis.core.project import ENGINE, PUBLISHED
from robo_genesis.maintain import report as refresh
from robo_genesis.maintain.pin import (
    FILES,
    RepinError,
    Versions,
    chosen_version,
    installable_versions,
    require_locked_packages,
    require_plain_files,
    set_pin,
)
from robo_genesis.pipeline.command import Progress, end_with_parent, say
from robo_genesis.pipeline.pages.kernels import kill_with_descendants
from robo_genesis.pipeline.worktree import environment, worktree

HEARTBEAT = 60.0
"""Seconds between two lines of progress of one command."""
TAIL = 25
"""How many last lines of a log an error shows."""


@dataclass(frozen=True, slots=True)
class Repin:
    """Which checkout gets which engine version.

    `versions` returns the installable ones, on request with pre-releases.
    """

    genesis: str
    root: Path = project.ROOT
    cache: Path = project.CACHE
    versions: Versions = installable_versions
    say: Callable[[str], None] = say


def run_repin(request: Repin) -> list[str]:
    """Try the version in a worktree of the last commit, then write pin and lock.

    Args:
        request: see there.

    Returns:
        The last lines for the user: what was changed, where the report is and what to do next.

    Raises:
        ProjectError, BundleRefused: nothing was changed.
    """
    root, folder = request.root, request.cache / "repin"
    require_plain_files(root)
    old = project.engine_pin(root)
    new = chosen_version(request.genesis, old, request.versions)
    if problems := unclean(root, "make repin tries the last commit"):
        raise RepinError("\n".join(problems))
    require_locked_packages(root)
    before = texts(root)

    busy = "Another make repin runs here (process {}). Wait for it, or stop it with Ctrl-C there."
    with (
        locked(folder / "lock", lambda process: RepinError(busy.format(process))),
        worktree(root, folder / "work", request.cache) as work,
    ):
        pages = Trial(request, old, new, work, Progress(request.say)).run()
        if texts(root) != before:
            raise RepinError(
                f"{' or '.join(FILES)} changed while {new} was tried, so neither is written. "
                "Commit or stash that change, then run make repin again; it reuses what is "
                "compiled and executed."
            )
        write(root, texts(work))
    return [
        f"Pinned: {ENGINE} {old} → {new}, in {' and '.join(FILES)}. Nothing is committed.",
        *(f"Report: {page}" for page in pages),
        "Review both; describe the changes in CHANGELOG.md under \"Evidence changed\". The next "
        "make book sets up .venv anew (with PYTHON=…, install the lock there first).",
        f"git restore {' '.join(FILES)} restores the old pin.",
    ]  # fmt: skip


def texts(root: Path) -> dict[str, bytes]:
    """Return the files of the pin by name."""
    return {name: (root / name).read_bytes() for name in FILES}


def write(root: Path, files: dict[str, bytes]) -> None:
    """Write the files of the pin."""
    for name, content in files.items():
        (root / name).write_bytes(content)


@dataclass(frozen=True, slots=True)
class Trial:
    """The steps in the worktree, each with its log."""

    request: Repin
    old: str
    new: str
    work: Path
    progress: Progress

    def run(self) -> list[Path]:
        """Resolve, build with the old and the new version, report, test; return the report."""
        set_pin(self.work, self.old, self.new)
        lock = str(self.work / "build_scripts" / "lock.py")
        self.command("resolve", f"{ENGINE} {self.new}", sys.executable, lock, "--keep")
        new = texts(self.work)
        git(self.work, "checkout", "--", *FILES)
        old_lock = (self.work / FILES[1]).read_text("utf8")
        self.command("book", f"with {self.old}", "make", "book", f"PYTHON={sys.executable}")
        recorded = refresh.recorded(self.work)
        built, aside = self.work / "book" / PUBLISHED, self.work / ".cache" / "old"
        built.rename(aside)
        write(self.work, new)
        python = f"BASE_PYTHON={sys.executable}"
        self.command("install", "the new lock", "make", ".venv/.installed", python)
        self.command("book", f"with {self.new}", "make", "book")
        found = refresh.compare_builds(
            (self.old, self.new),
            (aside, built),
            (recorded, refresh.recorded(self.work)),
            (old_lock, new[FILES[1]].decode()),
        )
        folder = self.request.cache / "reports" / f"repin-{self.old}-{self.new}"
        pages = refresh.document(found).write(folder)
        self.progress("report", refresh.summary(found), str(folder))
        self.command("test", f"make test with {self.new}", "make", "test")
        return pages

    def command(self, stage: str, what: str, *command: str) -> None:
        """Run one command in the worktree; a failure names it, its version and its log."""
        self.progress(stage, what)
        version = project.engine_pin(self.work)
        log = self.request.cache / "repin" / "logs" / f"{stage}-{version}.log"
        if run_logged(command, self.work, log, lambda: self.progress(stage, what, "still running")):
            lines = log.read_text("utf8", errors="replace").rstrip().splitlines()
            raise RepinError(
                "\n".join([*lines[-TAIL:], f"Log: {log}"])
                + f"\n\nGENESIS={self.new}: {stage} ({what}) failed. "
                f"The checkout still pins {self.old}."
            )


def run_logged(
    command: Sequence[str], folder: Path, log: Path, waiting: Callable[[], None] = lambda: None
) -> int:
    """Run a command in a worktree with its output in a log, and return its exit status.

    Args:
        command: program and arguments; it ends with this process.
        folder: the worktree.
        log: file of its output, written over.
        waiting: called once a minute while it runs.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("wb") as output:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env=environment(folder),
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # a Ctrl-C of the terminal reaches this process alone
            preexec_fn=end_with_parent(signal.SIGTERM),  # make passes it on
        )
        try:
            while process.poll() is None:
                try:
                    process.wait(HEARTBEAT)
                except subprocess.TimeoutExpired:
                    waiting()
        finally:
            if process.poll() is None:
                kill_with_descendants([process.pid])
    return process.returncode
