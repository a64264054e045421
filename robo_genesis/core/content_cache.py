"""A cache of files that depend only on their inputs: each is made once."""

import hashlib
import json
import os
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from robo_genesis.core.files import write_whole
from robo_genesis.core.project import CACHE, installed, lock_digest

DIGEST = hashlib.sha256().digest_size
KEPT = 30 * 24 * 3600
"""Seconds until an unused file is removed."""


def derived(
    kind: str, inputs: Iterable[bytes], make: Callable[[], bytes], cache: Path = CACHE
) -> bytes:
    """Return the result of `make`, from the cache if inputs, lock and environment are the same.

    Args:
        kind: name of the subfolder.
        inputs: everything that decides the result, including the source of the code that makes
            it; lock, Python and installed packages are added.
        make: called if the cache has no such file.
        cache: the cache folder.
    """
    key = hashlib.sha256(json.dumps([lock_digest(), sys.version, _installed()]).encode())
    for part in inputs:
        key.update(hashlib.sha256(part).digest())
    file = cache / "derived" / kind / key.hexdigest()
    content = _get(file)
    if content is None:
        content = make()
        with suppress(OSError):  # without a writable cache the result is made again each time
            write_whole(file, _seal(file, content) + content)
            _forget(file.parent)
    return content


@lru_cache(maxsize=1)
def _installed() -> list[tuple[str, str, int]]:
    return installed(sys.path)


def _get(file: Path) -> bytes | None:
    """Return the content of a file, None if it is missing or is not what was stored under its name.

    The digest covers the name, so that one stored file in the place of another is noticed.
    """
    try:
        os.utime(file)
        stored = file.read_bytes()
    except OSError:
        return None
    digest, content = stored[:DIGEST], stored[DIGEST:]
    if digest == _seal(file, content):
        return content
    print(f"{file} is not what was stored there: it is made again", file=sys.stderr)
    return None


def _seal(file: Path, content: bytes) -> bytes:
    return hashlib.sha256(f"{file.parent.name}/{file.name}\0".encode() + content).digest()


def _forget(folder: Path) -> None:
    oldest = time.time() - KEPT
    for file in folder.iterdir():
        if file.stat().st_mtime < oldest:
            file.unlink()
