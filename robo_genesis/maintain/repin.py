"""`make repin`: try another engine in a worktree of the last commit, then change pin and lock.

Nothing of the checkout is touched before the last step, which writes two files.
"""

import re
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.files import write_whole
from robo_genesis.core.git import git
from robo_genesis.core.project import ENGINE, PUBLISHED
from robo_genesis.pipeline.command import ANSI, Progress, end_with_parent, say
from robo_genesis.pipeline.release import environment, worktree

from . import report as refresh
from .lock import LOCK, write_lock

# What a change of the pin changes: measured results are never kept in the tree.
FILES = ("pyproject.toml", LOCK)

# The line of `make book` for a page that failed or whose bundle is refused, and why.
FAILED = re.compile(
    r"^\[ *[\d.]+ s\] \w+ +(.+?)  (failed|refused)\b.*?: (.+)\n", re.MULTILINE
)

LINES = 50  # How many last lines of a log an error shows


def run_repin(
    genesis: str,
    root: Path = project.ROOT,
    cache: Path = project.CACHE,
    say: Callable[[str], None] = say,
) -> list[str]:
    """Try the version in a worktree of the last commit, then write pin and lock.

    Args:
        genesis: the engine's version.
        root: the checkout.
        cache: the folder of its caches.
        say: prints a line.

    Returns:
        The last lines for the user: what was changed, where the report is and what to
            do next.

    Raises:
        ProjectError, BundleRefused: nothing was changed.
    """
    old, new = project.engine_pin(root), genesis.removeprefix("v")
    if new in ("", old):
        raise project.ProjectError(
            f"Name another version than the pin, {old}: make repin GENESIS=1.2.3."
        )
    shared = ("derived", project.COMPILED, "npm", project.STORE)
    with worktree(root, cache / "repin" / "work", cache, shared) as work:
        report = Trial(cache, old, new, work, Progress(say)).run()
        write(root, old, new, (work / LOCK).read_bytes())
    return [
        f"Pinned: {ENGINE} {old} → {new}, in {' and '.join(FILES)}. Nothing is committed.",
        f"Report: {report}",
        'Review both; describe the changes in CHANGELOG.md under "Evidence changed". The next '
        "make book installs the new lock (with PYTHON=…, install it there first).",
        "All recorded bundles are stale now.",
        f"git restore {' '.join(FILES)} restores the old pin.",
    ]


def write(root: Path, old: str, new: str, lock: bytes) -> None:
    """Write another engine version into the one line that pins it, and the lock."""
    path = root / FILES[0]
    text = path.read_text("utf8").replace(f"{ENGINE}=={old}", f"{ENGINE}=={new}")
    write_whole(path, text.encode())
    write_whole(root / LOCK, lock)


@dataclass(slots=True)
class Trial:
    """The steps in the worktree, each with its log.

    `before` is what the old version built, `failed` the name of each page that the
    current step did not accept → `failed` or `refused`, and why.
    """

    cache: Path
    old: str
    new: str
    work: Path
    progress: Progress
    before: refresh.EngineBuild | None = None
    failed: dict[str, refresh.Pair] = field(default_factory=dict)

    def run(self) -> Path:
        """Resolve, build with the old and the new version, report, test; return the report."""
        lock = self.work / LOCK
        write(self.work, self.old, self.new, lock.read_bytes())
        self.progress("resolve", f"{ENGINE} {self.new}")
        write_lock(self.work)
        new_lock = lock.read_bytes()
        git(self.work, "checkout", "--", *FILES)
        self.command("book", f"with {self.old}", f"PYTHON={sys.executable}")
        old_site = self.work / ".cache" / "old-site"
        self.site.rename(old_site)
        self.before = refresh.read_build(self.work, self.old, old_site)
        write(self.work, self.old, self.new, new_lock)
        self.command(
            ".venv/.installed", "the new lock", f"BASE_PYTHON={sys.executable}"
        )
        self.command("book", f"with {self.new}")
        report = self.write_report()
        self.command("test", f"with {self.new}")
        return report

    @property
    def site(self) -> Path:
        """The folder of the HTML that the worktree built."""
        return self.work / "book" / PUBLISHED / "html"

    def command(self, target: str, what: str, *settings: str) -> None:
        """Make one target there; a failure names it and its log, and ends with a report.

        Raises:
            ProjectError: the command failed.
        """
        stage = target.strip(".").partition("/")[0]
        log = self.cache / "repin" / "logs" / f"{stage}-{what.split()[-1]}.log"
        self.progress(stage, what, f"log: {log}")
        if not run_logged(["make", target, *settings], self.work, log):
            return
        text = ANSI.sub("", log.read_text("utf8", errors="replace"))
        if target == "book":  # the tests print builds of their own
            self.failed = {
                page: (state, why) for page, state, why in FAILED.findall(text)
            }
        head, lines = f"Failed: {target} {what}", text.splitlines()[-LINES:]
        remedy = (
            f"The checkout still pins {self.old}. Give another version, or change what failed "
            f"so that it passes with {self.new} too, and commit; then run make repin again. It "
            "reuses what is compiled and executed."
        )
        report = self.write_report(head, remedy)
        raise project.ProjectError(
            "\n".join(
                [*lines, f"Log: {log}", f"Report: {report}", "", f"{head}. {remedy}"]
            )
        )

    def write_report(self, *failed: str) -> Path:
        """Compare what both versions built, as far as they did, and write the report."""
        found = refresh.Refresh((self.old, self.new))
        if self.before:
            after = refresh.read_build(self.work, self.new, self.site)
            found = refresh.compare_builds(self.before, after)
        found = replace(found, failed=failed, pages=self.failed)
        folder = self.cache / "reports" / f"repin-{self.old}-{self.new}"
        self.progress("report", refresh.summary(found), str(folder))
        return refresh.document(found).write(folder)


def run_logged(command: list[str], folder: Path, log: Path) -> int:
    """Run a command in a worktree with its output in a log, and return its exit status.

    Args:
        command: program and arguments; it ends with this process.
        folder: the worktree.
        log: file of its output, written over.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command,
            cwd=folder,
            env=environment(folder),
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            preexec_fn=end_with_parent(signal.SIGTERM),  # make passes it on
        ) as process,
    ):
        return process.wait()
