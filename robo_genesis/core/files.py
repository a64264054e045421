"""Files that processes share: a lock, and files and folders that are replaced in one move."""

import fcntl
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

NEXT, OLD = ".next", ".old"


@contextmanager
def locked(path: Path, refusal: Callable[[str], Exception]) -> Iterator[None]:
    """Hold a lock file that names this process; the lock of a killed process is free.

    Args:
        path: the lock file; its folder is made where it is missing.
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
    """Write a file in one move: a killed process leaves no part of it in its place."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        partial.write_bytes(content)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def settle(folder: Path, prefix: str = "") -> None:
    """Bring a folder that is swapped in whole into order, after a kill at any point.

    Killed between the two renames, the old folder lies aside: it comes back. Killed later, it is
    only rubbish, as is a next one that was never swapped in.

    Args:
        folder: what `swap` exchanges; it need not exist.
        prefix: see `beside`.
    """
    aside = beside(folder, OLD, prefix)
    if aside.exists() and not folder.exists():
        aside.rename(folder)
    for other in (aside, beside(folder, NEXT, prefix)):
        if other.exists():
            shutil.rmtree(other)


def swap(folder: Path, prefix: str = "") -> None:
    """Put the complete next folder, which lies beside, in the place of a folder.

    Args:
        folder: `settle` repairs what a kill between the two renames leaves, and removes the old
            one.
        prefix: see `beside`.
    """
    if folder.exists():
        os.rename(folder, beside(folder, OLD, prefix))
    os.rename(beside(folder, NEXT, prefix), folder)


def beside(folder: Path, suffix: str, prefix: str = "") -> Path:
    """Return where the next or the old state of a folder lies; a prefix `.` hides it there."""
    return folder.with_name(f"{prefix}{folder.name}{suffix}")
