"""Files that processes share: a lock, atomic replacement, and a cache of derived files.

A derived file depends only on its inputs, and is made once.
"""

import fcntl
import hashlib
import json
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from .project import CACHE, ProjectError, installed, lock_digest

NEXT, OLD = ".next", ".old"
KEPT = 30 * 24 * 3600  # Seconds until an unused file is removed

# Names of what Python and Jupyter make; the same with hidden files and back-ups of
# editors.
MADE_BY_TOOLS = ("__pycache__", ".ipynb_checkpoints")
NO_SOURCE = ("__pycache__", ".*", "*~", "#*#", "*.bak", "*.orig", "*.rej")


@contextmanager
def locked(path: Path, what: str) -> Iterator[None]:
    """Lock a file that names this process; the operating system frees the lock of a killed process.

    Args:
        path: the lock file; its folder is made if it is missing.
        what: the beginning of the message: what holds the lock.

    Raises:
        ProjectError: another process holds the lock; the message names it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            process = lock.read().strip() or "unknown"
            raise ProjectError(
                f"{what} runs here (process {process}). Wait until it ends, or stop it with Ctrl-C "
                f"in its terminal or `kill {process}`."
            ) from None
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


def settle(folder: Path) -> None:
    """Repair a folder after a process was killed while it replaced the folder; see `replaced`.

    If the old folder was already moved aside and there is no new one, it is restored.
    Otherwise the old folder and an unused next one are removed.

    Args:
        folder: it need not exist.
    """
    aside = beside(folder, OLD)
    if aside.exists() and not folder.exists():
        aside.rename(folder)
    for other in (aside, beside(folder, NEXT)):
        if other.exists():
            shutil.rmtree(other)


def settle_below(folder: Path) -> None:
    """Repair all folders at the second level below a folder; see `settle`."""
    for suffix in (OLD, NEXT):
        for left in folder.glob(f"*/.*{suffix}"):
            settle(left.with_name(left.stem.removeprefix(".")))


@contextmanager
def replaced(folder: Path) -> Iterator[Path]:
    """Replace a folder in one move with one that the caller creates; a failure changes nothing.

    Args:
        folder: moved aside, then removed. `settle` repairs a replacement that was
            killed.

    Yields:
        The path of the new folder, which the caller makes.
    """
    settle(folder)
    following = beside(folder, NEXT)
    try:
        yield following
        if folder.exists():
            os.rename(folder, beside(folder, OLD))
        os.rename(following, folder)
    finally:
        settle(folder)


def beside(folder: Path, suffix: str) -> Path:
    """Return the path of the next or the old state of a folder, which is hidden."""
    return folder.with_name(f".{folder.name}{suffix}")


def put(source: Path, folder: Path) -> None:
    """Copy a folder to a place, whole or not at all; an older one there is replaced.

    Raises:
        OSError: the copy failed; nothing has changed.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    with replaced(folder) as following:
        shutil.copytree(source, following)


def files_below(
    folder: Path, left_out: Sequence[str] = MADE_BY_TOOLS
) -> Iterator[Path]:
    """Yield all files below a folder.

    Args:
        folder: it need not exist.
        left_out: patterns of names of files and folders that are left out anywhere.
    """
    ignored = shutil.ignore_patterns(*left_out)
    for here, folders, files in os.walk(folder):
        gone = ignored(here, [*folders, *files])
        folders[:] = [name for name in folders if name not in gone]
        yield from (Path(here, name) for name in files if name not in gone)


def files_digest(base: Path, files: Iterable[Path]) -> str:
    """Return the digest of names and contents of files; an absent one counts as such.

    Args:
        base: the names begin below it.
        files: their order does not matter.
    """
    found = hashlib.sha256()
    for path in sorted(files):
        content = bytes_digest(path.read_bytes()) if path.is_file() else "absent"
        found.update(os.fsencode(path.relative_to(base)) + f"\0{content}\n".encode())
    return found.hexdigest()


def bytes_digest(content: bytes) -> str:
    """Return the hexadecimal SHA-256 of some bytes."""
    return hashlib.sha256(content).hexdigest()


def json_digest(value: Any) -> str:
    """Return the SHA-256 of a JSON value."""
    return bytes_digest(json.dumps(value, sort_keys=True).encode())


def derived_value(kind: str, inputs: Any, make: Callable[[], Any]) -> Any:
    """Return the result of `make`, a JSON value; see `derived`.

    Args:
        kind: name of the subfolder.
        inputs: everything that decides the result, a JSON value.
        make: a function or lambda; the module that defines it is one of the inputs.
    """
    given = [json.dumps(inputs).encode(), _source(make.__code__.co_filename)]
    return json.loads(derived(kind, given, lambda: json.dumps(make()).encode()))


@lru_cache
def _source(file: str) -> bytes:
    return Path(file).read_bytes()


def derived(
    kind: str, inputs: Iterable[bytes], make: Callable[[], bytes], cache: Path = CACHE
) -> bytes:
    """Return the result of `make`, from the cache if inputs, lock and environment are the same.

    Args:
        kind: name of the subfolder.
        inputs: everything that decides the result, including the source of the code
            that makes it; lock, Python and installed packages are added.
        make: called if the cache has no such file.
        cache: the cache folder.
    """
    try:
        lock = lock_digest()
    except ProjectError:  # an installed package has no checkout, and so no cache
        return make()
    key = hashlib.sha256(json.dumps([sys.version, lock, _installed()]).encode())
    for part in inputs:
        key.update(hashlib.sha256(part).digest())
    file = cache / "derived" / kind / key.hexdigest()
    try:
        os.utime(file)
        return file.read_bytes()
    except OSError:
        content = make()
    with suppress(OSError):  # without a writable cache it is made again each time
        write_whole(file, content)
        _forget(file.parent)
    return content


@lru_cache(maxsize=1)
def _installed() -> str:
    return json_digest(installed())


def _forget(folder: Path) -> None:
    oldest = time.time() - KEPT
    for file in folder.iterdir():
        if file.stat().st_mtime < oldest:
            file.unlink()
