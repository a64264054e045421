"""`make repin`: try another engine in a fresh checkout, then change pin and lock.

Nothing of the checkout is touched before the last step, which writes two files.
"""

import re
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from importlib.metadata import distributions
from pathlib import Path

from packaging.utils import canonicalize_name
from packaging.version import InvalidVersion, Version

from robo_genesis.core import project
from robo_genesis.core.files import locked, write_whole
from robo_genesis.core.git import git, unclean
from robo_genesis.core.project import ENGINE, PUBLISHED, locked_versions
from robo_genesis.maintain import report as refresh
from robo_genesis.pipeline.command import ANSI, Progress, end_with_parent, say
from robo_genesis.pipeline.fresh_checkout import environment, fresh_checkout
from robo_genesis.pipeline.pages.kernels import wait_or_kill

# What a change of the pin changes: measured results are never kept in the tree.
FILES = ("pyproject.toml", "requirements.lock")

# The line of `make book` for a page that failed or whose bundle is refused, and why.
FAILED = re.compile(
    r"^\[ *[\d.]+ s\] \w+ +(.+?)  (failed|refused)\b.*?: (.+)\n", re.MULTILINE
)

LINES = 50  # How many last lines of a log an error and the report show


def run_repin(
    genesis: str,
    root: Path = project.ROOT,
    cache: Path = project.CACHE,
    say: Callable[[str], None] = say,
) -> list[str]:
    """Try the version in a checkout of the last commit, then write pin and lock.

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
    folder, old = cache / "repin", project.engine_pin(root)
    new = wanted_version(genesis, old)
    if problems := unclean(root, "make repin tries the last commit"):
        raise project.ProjectError("\n".join(problems))
    require_locked_packages(root)
    before = texts(root)

    with (
        locked(folder / "lock", "Another make repin"),
        fresh_checkout(root, folder / "work", cache) as work,
    ):
        trial = Trial(cache, old, new, work, Progress(say))
        report, new = trial.run(), trial.new
        if texts(root) != before:
            raise project.ProjectError(
                f"{' or '.join(FILES)} changed while {new} was tried, so neither is written. "
                "Commit or stash that change, then run make repin again; it reuses what is "
                "compiled and executed."
            )
        write(root, texts(work))
    return [
        f"Pinned: {ENGINE} {old} → {new}, in {' and '.join(FILES)}. Nothing is committed.",
        f"Report: {report}",
        'Review both; describe the changes in CHANGELOG.md under "Evidence changed". The next '
        "make book sets up .venv anew (with PYTHON=…, install the lock there first).",
        f"git restore {' '.join(FILES)} restores the old pin.",
    ]


def wanted_version(given: str, pin: str) -> str:
    """Return the wanted version, without a leading `v`; whether it exists, pip knows.

    Args:
        given: what the user gave.
        pin: the version that is pinned now.

    Raises:
        ProjectError: it is not a version, or it is the pin.
    """
    try:
        version = Version(given)
    except InvalidVersion:
        valid = f"Usage: make repin GENESIS=1.2.3 (the pin is {pin})."
        raise project.ProjectError(
            f"GENESIS={given!r} is not a version. {valid}"
        ) from None
    if version == Version(pin):
        raise project.ProjectError(
            f"GENESIS={given} is the pin already. Give another version."
        )
    return str(version)


def require_locked_packages(root: Path) -> None:
    """Raise ProjectError if this environment is not the one that the lock describes.

    The new lock keeps the installed versions, so they must be those of the old one.
    """
    installed = {
        canonicalize_name(d.name): d.version.split("+")[0] for d in distributions()
    }
    unlike = [
        f"{name} {found} instead of {version}"
        for name, version in locked_versions(
            (root / FILES[1]).read_text("utf8")
        ).items()
        if (found := installed.get(canonicalize_name(name), "(none)")) != version
    ]
    if unlike:
        raise project.ProjectError(
            f"This environment differs from requirements.lock: {', '.join(unlike)}. Install the "
            "lock (pip install -r requirements.lock), or omit PYTHON=…, so that .venv is used."
        )


def set_pin(root: Path, old: str, new: str) -> None:
    """Write another engine version into the one line that pins it.

    Raises:
        ProjectError: the line is not written as expected.
    """
    path = root / FILES[0]
    pattern = rf"(?<=[\"']){ENGINE}\s*==\s*{re.escape(old)}(?=[\"'])"
    text, count = re.subn(pattern, f"{ENGINE}=={new}", path.read_text("utf8"))
    if count != 1:
        raise project.ProjectError(
            f'{path} has "{ENGINE}=={old}" {count} times, expected once. Write the pin in one line.'
        )
    path.write_text(text, "utf8")


def texts(root: Path) -> dict[str, bytes]:
    """Return the files of the pin by name."""
    return {name: (root / name).read_bytes() for name in FILES}


def write(root: Path, files: dict[str, bytes]) -> None:
    """Write the files of the pin."""
    for name, content in files.items():
        write_whole(root / name, content)


@dataclass(slots=True)
class Trial:
    """The steps in the checkout, each with its log.

    `before` is what the old version built, `failed` what the current step has found:
    the name of each page that is not accepted → `failed` or `refused`, and why.
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
        set_pin(self.work, self.old, self.new)
        lock = str(self.work / "build_scripts" / "lock.py")
        self.command("resolve", f"{ENGINE} {self.new}", sys.executable, lock, "--keep")
        asked, locked = (
            self.new,
            locked_versions((self.work / FILES[1]).read_text("utf8")),
        )
        self.new = locked[ENGINE]  # as the index spells it
        set_pin(self.work, asked, self.new)
        new = texts(self.work)
        git(self.work, "checkout", "--", *FILES)
        self.command(
            "book", f"with {self.old}", "make", "book", f"PYTHON={sys.executable}"
        )
        site = (self.work / "book" / PUBLISHED).rename(
            self.work / ".cache" / "old"
        ) / "html"
        self.before = refresh.read_build(self.work, self.old, site)
        write(self.work, new)
        python = f"BASE_PYTHON={sys.executable}"
        self.command("install", "the new lock", "make", ".venv/.installed", python)
        self.command("book", f"with {self.new}", "make", "book")
        report = self.write_report()
        self.command("test", f"with {self.new}", "make", "test")
        return report

    def command(self, stage: str, what: str, *command: str) -> None:
        """Run one command there; a failure names it and its log, and ends with a report.

        Raises:
            ProjectError: the command failed.
        """
        version = project.engine_pin(self.work)
        log = self.cache / "repin" / "logs" / f"{stage}-{version}.log"
        self.progress(stage, what, f"log: {log}")
        self.failed = {}
        if run_logged(command, self.work, log, lambda: self.name_failed(stage, log)):
            self.name_failed(stage, log)
            head, lines = f"Failed: {stage} {what}", last_words(log)
            remedy = (
                f"The checkout still pins {self.old}. Give another version, or change what failed "
                f"so that it passes with {self.new} too, and commit; then run make repin again. It "
                "reuses what is compiled and executed, and begins with the pages that failed."
            )
            places = [
                f"Log: {log}",
                f"Report: {self.write_report(head, remedy, *lines)}",
            ]
            raise project.ProjectError(
                "\n".join([*lines, *places, "", f"{head}. {remedy}"])
            )

    def name_failed(self, stage: str, log: Path) -> None:
        """Print each page of a build that failed or was refused since the last call."""
        for page, state, why in FAILED.findall(log.read_text("utf8", errors="replace")):
            if (
                stage == "book" and page not in self.failed
            ):  # tests print builds of their own
                self.failed[page] = state, why
                self.progress(stage, page, f"{state}: {why}")

    def write_report(self, *failed: str) -> Path:
        """Compare what both versions built, as far as they did, and write the report."""
        found = refresh.Refresh((self.old, self.new))
        if self.before:
            site = self.work / "book" / PUBLISHED / "html"
            absent = [
                page for page, (state, _) in self.failed.items() if state == "failed"
            ]
            after = refresh.read_build(self.work, self.new, site, absent)
            found = refresh.compare_builds(self.before, after)
        found = replace(found, failed=failed, pages=self.failed)
        folder = self.cache / "reports" / f"repin-{self.old}-{self.new}"
        self.progress("report", refresh.summary(found), str(folder))
        return refresh.document(found).write(folder)


def last_words(log: Path) -> list[str]:
    """Return what a command wrote after its last line of progress, without empty lines."""
    text = ANSI.sub("", log.read_text("utf8", errors="replace"))
    after = re.split(r"^\[ *[\d.]+ s\] .*$", text, flags=re.MULTILINE)[-1]
    return [line.rstrip() for line in after.splitlines() if line.strip()][-LINES:]


def run_logged(
    command: Sequence[str],
    folder: Path,
    log: Path,
    meanwhile: Callable[[], None] = lambda: None,
) -> int:
    """Run a command in a checkout with its output in a log, and return its exit status.

    Args:
        command: program and arguments; it ends with this process.
        folder: the checkout.
        log: file of its output, written over.
        meanwhile: called each second.
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
            # a Ctrl-C of the terminal reaches this process alone
            start_new_session=True,
            preexec_fn=end_with_parent(signal.SIGTERM),  # make passes it on
        )
        return wait_or_kill(process, meanwhile)
