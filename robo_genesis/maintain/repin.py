"""The steps of `make repin`: try another engine version in a worktree, then change pin and lock.

Nothing of the checkout is touched before the last step, which writes two files.
"""

import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.build.publish import PUBLISHED
from robo_genesis.build.stages import Progress
from robo_genesis.core import project
from robo_genesis.core.files import locked
from robo_genesis.core.git import git, git_or_none, unclean
from robo_genesis.core.project import ENGINE
from robo_genesis.evidence import report
from robo_genesis.evidence.status import Status
from robo_genesis.maintain import report as refresh
from robo_genesis.maintain.logged import run_logged
from robo_genesis.maintain.pin import (
    FILES,
    RepinError,
    Versions,
    chosen_version,
    require_locked_packages,
    require_plain_files,
    set_pin,
)

SHARED = ("engine", "pages")
"""Caches that the worktree shares with the checkout: their folders are named by their inputs."""

OLD_BUILD = "old"
"""The folder beside the worktree that keeps the build with the old version."""
TAIL = 25
"""How many last lines of a log an error shows."""


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
    """Try the version in a worktree of the last commit, then write pin and lock.

    Args:
        asked: see there.

    Returns:
        The last lines for the user: what was changed, where the report is and what to do next.

    Raises:
        RepinError, ProjectError: nothing was changed.
    """
    folder = asked.cache / "repin"
    require_plain_files(asked.root)
    old = project.engine_pin(asked.root)
    new = chosen_version(asked.genesis, old, asked.versions)
    if problems := unclean(asked.root, "make repin tries the last commit"):
        raise RepinError("\n".join(problems))
    require_locked_packages(asked.root)
    before = texts(asked.root)
    with only_repin(folder), worktree(asked, folder / "work") as work:
        steps = Steps(asked, old, new, work, folder / "logs", Progress(asked.say))
        pages = steps.try_version()
        if texts(asked.root) != before:
            raise RepinError(
                f"{' or '.join(FILES)} changed while {new} was tried, so neither is written. "
                "Commit or stash that change, then run make repin again; what is compiled and "
                "executed is reused."
            )
        write(asked.root, texts(work))
    return [
        f"Pinned: {ENGINE} {old} → {new}, in {' and '.join(FILES)}. Nothing is committed.",
        *(f"Report: {page}" for page in pages),
        "Review both; say in CHANGELOG.md under \"Evidence changed\" what changed. The next make "
        "book sets up .venv anew (with PYTHON=…, install the lock there first).",
        f"git restore {' '.join(FILES)} brings the old pin back.",
    ]  # fmt: skip


def texts(root: Path) -> dict[str, bytes]:
    """Return the files of the pin by name."""
    return {name: (root / name).read_bytes() for name in FILES}


def write(root: Path, files: dict[str, bytes]) -> None:
    """Write the files of the pin."""
    for name, content in files.items():
        (root / name).write_bytes(content)


def only_repin(folder: Path) -> AbstractContextManager[None]:
    """Hold the lock of changing the pin.

    Raises:
        RepinError: another process holds it.
    """
    return locked(
        folder / "lock",
        lambda process: RepinError(
            f"Another make repin runs here (process {process}). Wait for it, or stop it with "
            "Ctrl-C there."
        ),
    )


@contextmanager
def worktree(asked: Repin, work: Path) -> Iterator[Path]:
    """Check the last commit out in a worktree with shared caches; remove it in the end.

    Raises:
        ProjectError: git cannot make it.
    """
    remove_worktree(asked.root, work)  # of a run that was killed
    try:
        git(asked.root, "worktree", "add", "--detach", str(work), "HEAD")
        (work / ".cache").mkdir()
        for name in SHARED:
            (asked.cache / name).mkdir(parents=True, exist_ok=True)
            (work / ".cache" / name).symlink_to(asked.cache / name)
        yield work
    finally:
        remove_worktree(asked.root, work)


def remove_worktree(root: Path, work: Path) -> None:
    """Remove a worktree, the old build beside it and git's record, a locked one included.

    `git worktree prune` would keep the record of one whose making was killed, and forget worktrees
    of the user on a disk that is not mounted.
    """
    for folder in (work, work.with_name(OLD_BUILD)):
        shutil.rmtree(folder, ignore_errors=True)
    git_or_none(root, "worktree", "remove", "--force", "--force", str(work))


@dataclass(frozen=True, slots=True)
class Steps:
    """The steps in the worktree, in their order, each with its log."""

    asked: Repin
    old: str
    new: str
    work: Path
    logs: Path
    progress: Progress

    def try_version(self) -> list[Path]:
        """Resolve, measure with the old and the new version, report, test; return the report."""
        old_texts = texts(self.work)
        self.resolve()
        new_texts = texts(self.work)
        write(self.work, old_texts)
        before = self.build_old()
        write(self.work, new_texts)
        self.build_new()
        pages = self.report(old_texts, before)
        self._run("test", f"all tests with {self.new}", "make", "test")
        return pages

    def resolve(self) -> None:
        """Change the pin of the worktree, and in its lock only what the pin forces to change."""
        set_pin(self.work, self.old, self.new)
        script = str(self.work / "build_scripts" / "lock.py")
        self._run("resolve", f"{ENGINE} {self.new}", sys.executable, script, "--keep")

    def build_old(self) -> tuple[Path, dict[str, Status]]:
        """Build the book with this environment; return the build and what is recorded."""
        self._run("book", f"with {self.old}", "make", "book", f"PYTHON={sys.executable}")
        aside = self.work.with_name(OLD_BUILD)
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
        """Compare both builds and write the refresh report."""
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

    def _run(self, stage: str, what: str, *command: str) -> None:
        """Run one command in the worktree; a failure names it, its version and its log."""
        self.progress(stage, what)
        version = self.old if command[-1].startswith("PYTHON=") else self.new
        log = self.logs / f"{stage}-{version}.log"
        if run_logged(command, self.work, log, lambda: self.progress(stage, what, "still running")):
            lines = log.read_text("utf8", errors="replace").rstrip().splitlines()
            raise RepinError(
                "\n".join([*lines[-TAIL:], f"Log: {log}"])
                + f"\n\nGENESIS={self.new}: {stage} ({what}) failed. "
                f"The checkout still pins {self.old}, as it was."
            )
