"""A copy of the working tree with its own environment, in which commands run and leave logs."""

import ctypes
import os
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from robo_genesis.kernels import kill_with_descendants
from robo_genesis.project import ProjectError

SHARED = ("engine", "pages")
"""Caches that the copy shares with the checkout: named by what decides their content."""

OWN = (
    "GENESIS", "PYTHON", "PYTHONPATH", "BUNDLE", "RELEASE", "EXECUTED", "MAKEFLAGS", "MFLAGS",
    "MAKELEVEL",
)  # fmt: skip
"""Variables of the outer make that mean nothing to a make in the copy, or the wrong thing: a new
pin makes recorded bundles stale, which a release would refuse."""

WISHES = ("JOBS", "RENDER", "SITE_URL", "ROWS", "RUNS", "PAGE", "TO", "REPORT", "OLD", "NEW")
"""Variables by which a user tells make what to do; a measurement tells each command its own."""

ANEW = (".venv", ".cache")
"""Links of these names are no folders for git to ignore, and lead to what others use."""

HEARTBEAT = 60.0
TAIL = 25


class CommandError(Exception):
    """A command in the copy failed; the message holds the end of its log and the log's path."""


def copy_tree(root: Path, work: Path, cache: Path, shared: Sequence[str] = SHARED) -> None:
    """Copy a checkout as it stands, uncommitted changes and new files included.

    Args:
        root: the checkout; what git ignores is not copied.
        work: the copy, a repository of its own; what stands there is removed.
        cache: the cache folder of the checkout.
        shared: folders of it that the copy uses, by links.

    Raises:
        ProjectError: the checkout is no git repository, git cannot copy it, or it holds another.
    """
    names = _git(root, "ls-files", "-z", "--cached", "--others", "--exclude-standard")
    _refuse_repositories(root, names)
    if work.exists():
        shutil.rmtree(work)
    work.parent.mkdir(parents=True, exist_ok=True)
    _git(root, "clone", "--quiet", "--", str(root), str(work))
    for name in _git(work, "ls-files", "-z"):
        (work / name).unlink(missing_ok=True)
    for name in names:
        if name not in ANEW and os.path.lexists(root / name) and not _is_folder(root / name):
            (work / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(root / name, work / name, follow_symlinks=False)
    (work / ".cache").mkdir()
    for name in shared:
        (cache / name).mkdir(parents=True, exist_ok=True)
        (work / ".cache" / name).symlink_to(cache / name)


def _refuse_repositories(root: Path, names: list[str]) -> None:
    """Raise ProjectError where a name of git's is a repository within the checkout, not a file."""
    folders = [n for n in names if _is_folder(root / n) and os.path.lexists(root / n / ".git")]
    if folders:
        raise ProjectError(
            f"The checkout {root} holds other repositories: {', '.join(folders)}. A new pin is "
            "tried in a copy of the files of one repository. Move them away, or name them in "
            ".gitignore."
        )


def _is_folder(path: Path) -> bool:
    """Return whether a folder stands there itself; in place of a file, that file was deleted."""
    return path.is_dir() and not path.is_symlink()


def _git(folder: Path, *arguments: str) -> list[str]:
    """Run git in a folder and return the names that it prints, separated by NUL.

    A name need not be UTF-8; one that is not is kept as Python keeps names of files.
    """
    command = ["git", "-C", str(folder), *arguments]
    try:
        done = subprocess.run(command, capture_output=True, check=False)
    except FileNotFoundError as error:
        raise ProjectError("There is no git. Install it: apt install git.") from error
    if done.returncode:
        reason = done.stderr.decode("utf8", "replace").strip()
        raise ProjectError(
            f"git cannot read the checkout {folder}: {reason}\n"
            "A new pin is tried in a clone of the checkout; get the course with git clone."
        )
    return [os.fsdecode(name) for name in done.stdout.split(b"\0") if name]


def run_logged(
    command: Sequence[str],
    work: Path,
    log: Path,
    waiting: Callable[[], None] = lambda: None,
) -> None:
    """Run a command in the copy, its output in a log; nothing of it survives this process.

    Args:
        command: program and arguments.
        work: the copy.
        log: file of its output, written over.
        waiting: called once a minute while it runs.

    Raises:
        CommandError: its exit status is not 0.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    environment = {name: value for name, value in os.environ.items() if name not in OWN}
    with log.open("wb") as output:
        process = subprocess.Popen(
            command,
            cwd=work,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # a Ctrl-C of the terminal reaches this process alone
            preexec_fn=_end_with_parent,
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
    if process.returncode:
        raise CommandError("\n".join([*_tail(log), f"Log: {log}"]))


def _end_with_parent() -> None:
    """Ask Linux for a SIGTERM when the parent is gone, by SIGKILL too; make passes it on."""
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of <sys/prctl.h>
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGTERM)


def _tail(log: Path) -> Iterator[str]:
    """Yield the last lines of a log."""
    yield from log.read_text("utf8", errors="replace").rstrip().splitlines()[-TAIL:]
