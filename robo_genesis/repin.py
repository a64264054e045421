"""The steps of `make repin`: try another engine version in a copy, then change pin and lock.

Nothing of the checkout is touched before the last step. That one is `apply`, which a kill leaves
at the old or the new state.
"""

import fcntl
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from robo_genesis import project, refresh
from robo_genesis.apply import apply, digest, recover
from robo_genesis.build import Progress
from robo_genesis.evidence import report
from robo_genesis.evidence.status import Status
from robo_genesis.pin import (
    FILES,
    RepinError,
    Versions,
    chosen_version,
    require_locked_packages,
    require_plain_files,
    set_pin,
)
from robo_genesis.project import ENGINE
from robo_genesis.publish import PUBLISHED
from robo_genesis.workcopy import CommandError, copy_tree, run_logged


@dataclass(frozen=True, slots=True)
class Repin:
    """Which checkout gets which engine version.

    `versions` returns those that can be installed, pre-releases included where asked for.
    """

    genesis: str
    root: Path
    cache: Path
    versions: Versions
    say: Callable[[str], None] = print


def run_repin(asked: Repin) -> list[str]:
    """Try the version in a copy of the checkout and apply it.

    Args:
        asked: see there.

    Returns:
        The last lines for the user: what was changed, where the report is and what to do next.

    Raises:
        RepinError, ProjectError: nothing was changed.
        ApplyError: pin or lock were edited meanwhile; nothing was changed.
        UnfinishedError: the next make completes the change.
    """
    folder = asked.cache / "repin"
    recover(asked.root)
    require_plain_files(asked.root)
    old = project.engine_pin(asked.root)
    new = chosen_version(asked.genesis, old, asked.versions)
    require_locked_packages(asked.root)
    with only_repin(folder):
        work = folder / "work"
        try:
            steps = Steps(asked, old, new, work, folder / "logs", Progress(asked.say))
            before = steps.copy()
            pages = steps.try_version()
            with uninterrupted():
                apply(asked.root, work, before)
                tidy(folder)
        finally:
            tidy(folder)
    return [
        f"Pinned: {ENGINE} {old} → {new}, in {' and '.join(FILES)}. Nothing is committed.",
        *(f"Report: {page}" for page in pages),
        "Review both; say in CHANGELOG.md under \"Evidence changed\" what changed. The next make "
        "book sets up .venv anew (with PYTHON=…, install the lock there first).",
    ]  # fmt: skip


def tidy(folder: Path) -> None:
    """Remove the copy and the old build; what a kill leaves, the next make repin removes."""
    for rubbish in (folder / "work", folder / "old"):
        shutil.rmtree(rubbish, ignore_errors=True)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Ignore a Ctrl-C that comes too late: it would say that nothing was changed."""
    signals = (signal.SIGINT, signal.SIGTERM)
    handlers = [signal.signal(one, signal.SIG_IGN) for one in signals]
    try:
        yield
    finally:
        for one, handler in zip(signals, handlers, strict=True):
            signal.signal(one, handler)


@contextmanager
def only_repin(folder: Path) -> Iterator[None]:
    """Hold the lock of changing the pin.

    Raises:
        RepinError: another process holds it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("a+") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            raise RepinError(
                f"Another make repin runs here (process {lock.read().strip() or 'unknown'}). "
                "Wait for it, or stop it with Ctrl-C there."
            ) from None
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


@dataclass(frozen=True, slots=True)
class Steps:
    """The steps in the copy, in their order, each with its log."""

    asked: Repin
    old: str
    new: str
    work: Path
    logs: Path
    progress: Progress

    def copy(self) -> dict[str, str]:
        """Copy the checkout; return each file that will be changed with its digest."""
        self.progress("copy", str(self.work))
        copy_tree(self.asked.root, self.work, self.asked.cache)
        return {name: digest(self.work / name) for name in FILES}

    def try_version(self) -> list[Path]:
        """Resolve, measure with the old and the new version, report, test; return the report."""
        old_texts = {name: (self.work / name).read_bytes() for name in FILES}
        self.resolve()
        new_texts = {name: (self.work / name).read_bytes() for name in FILES}
        self._write(old_texts)
        before = self.build_old()
        self._write(new_texts)
        self.build_new()
        pages = self.report(old_texts, before)
        self._run("test", f"all tests with {self.new}", "make", "test")
        return pages

    def resolve(self) -> None:
        """Change the pin of the copy, and in its lock only what the pin forces to change."""
        set_pin(self.work, self.old, self.new)
        script = str(self.work / "build_scripts" / "lock.py")
        self._run("resolve", f"{ENGINE} {self.new}", sys.executable, script, "--keep")

    def build_old(self) -> tuple[Path, dict[str, Status]]:
        """Build the book as it stands, with this environment; return it and what is recorded."""
        self._run("book", f"with {self.old}", "make", "book", f"PYTHON={sys.executable}")
        aside = self.work.parent / "old"
        shutil.rmtree(aside, ignore_errors=True)
        (self.work / "book" / PUBLISHED).rename(aside)
        return aside, refresh.recorded(self.work)

    def build_new(self) -> None:
        """Set up the new environment and build the book with it."""
        python = f"BASE_PYTHON={sys.executable}"
        self._run("install", "the new lock", "make", ".venv/.installed", python)
        self._run("book", f"with {self.new}", "make", "book")

    def report(
        self, old_texts: dict[str, bytes], before: tuple[Path, dict[str, Status]]
    ) -> list[Path]:
        """Hold both builds one against the other and write the refresh report."""
        aside, recorded = before
        found = refresh.compare_builds(
            (self.old, self.new), (aside, self.work / "book" / PUBLISHED),
            (recorded, refresh.recorded(self.work)),
            (old_texts[FILES[1]].decode(), (self.work / FILES[1]).read_text("utf8")),
        )  # fmt: skip
        folder = self.asked.cache / "reports" / f"repin-{self.old}-{self.new}"
        pages = report.write(folder, refresh.markdown(found), refresh.html(found))
        self.progress("report", refresh.summary(found), str(folder))
        return pages

    def _write(self, texts: dict[str, bytes]) -> None:
        for name, text in texts.items():
            (self.work / name).write_bytes(text)

    def _run(self, stage: str, what: str, *command: str) -> None:
        """Run one command of the copy; a failure says which, with which version, and what now."""
        self.progress(stage, what)
        log = (
            self.logs / f"{stage}-{self.old if command[-1].startswith('PYTHON=') else self.new}.log"
        )
        try:
            run_logged(command, self.work, log, lambda: self.progress(stage, what, "still running"))
        except CommandError as failure:
            raise RepinError(
                f"{failure}\n\nGENESIS={self.new}: {stage} ({what}) failed. "
                f"The checkout still pins {self.old}, as it was."
            ) from failure
