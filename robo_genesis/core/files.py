"""Files that processes share: a lock, and atomic replacement of files and folders."""

import fcntl
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

NEXT, OLD = ".next", ".old"


@contextmanager
def locked(path: Path, refusal: Callable[[str], Exception]) -> Iterator[None]:
    """Lock a file that names this process; the operating system frees the lock of a killed process.

    Args:
        path: the lock file; its folder is made if it is missing.
        refusal: returns the exception to raise while another process holds the lock. Its argument
            is the id of that process, or `unknown`.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            raise refusal(lock.read().strip() or "unknown") from None
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


def write_whole(path: Path, content: bytes) -> None:
    """Write a file atomically: a killed process leaves no partial file at `path`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        partial.write_bytes(content)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def settle(folder: Path, prefix: str = "") -> None:
    """Repair a folder after a process was killed while it replaced the folder; see `replaced`.

    If the old folder was already moved aside and there is no new one, it is restored. Otherwise
    the old folder and an unused next one are removed.

    Args:
        folder: it need not exist.
        prefix: see `beside`.
    """
    aside = beside(folder, OLD, prefix)
    if aside.exists() and not folder.exists():
        aside.rename(folder)
    for other in (aside, beside(folder, NEXT, prefix)):
        if other.exists():
            shutil.rmtree(other)


@contextmanager
def replaced(folder: Path, prefix: str = "") -> Iterator[Path]:
    """Replace a folder in one move with one that the caller creates; a failure changes nothing.

    Args:
        folder: moved aside, then removed. `settle` repairs a replacement that was killed.
        prefix: see `beside`.

    Yields:
        The path of the new folder, which the caller makes.
    """
    settle(folder, prefix)
    following = beside(folder, NEXT, prefix)
    try:
        yield following
        if folder.exists():
            os.rename(folder, beside(folder, OLD, prefix))
        os.rename(following, folder)
    finally:
        settle(folder, prefix)


def beside(folder: Path, suffix: str, prefix: str = "") -> Path:
    """Return the path of the next or the old state of a folder; a prefix `.` hides it."""
    return folder.with_name(f"{prefix}{folder.name}{suffix}")
