"""The files of a bundle, looked at before any is read: confined, bounded, listed, unchanged."""

import os
import re
import stat
from collections.abc import Iterator
from pathlib import Path

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence.bundle import Manifest, sha256

MIB = 2**20
SIZE_LIMITS = {"manifest.json": MIB, "metrics.json": MIB, "arrays.json": MIB, "log.txt": 4 * MIB}
OTHER_LIMIT = 16 * MIB
"""Bytes of one archive or picture; those of a lesson have under 0.1 MiB."""

ENTRIES_LIMIT = 200
REQUIRED = {"metrics.json", "arrays.json", "log.txt"}
NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*(/[A-Za-z0-9_-][A-Za-z0-9_.-]*)*")
KNOWN = re.compile(r"metrics\.json|arrays\.json|log\.txt|arrays/\w+\.npz|frames/\w+\.png")


def scan(folder: Path) -> set[str]:
    """Return the names of a bundle's files after holding kind, number and size of each to bounds.

    Nothing is opened here: a link, a pipe or a huge file is refused before it can do harm.

    Raises:
        BundleRefused: `missing-file`, `path` or `too-big`.
    """
    if folder.is_symlink():
        raise BundleRefused("path", f"{folder.name} is a link, expected the folder itself. {AGAIN}")
    if not os.path.lexists(folder / "manifest.json"):
        raise BundleRefused(
            "missing-file", f"{folder.name} has no manifest.json, expected a bundle. {AGAIN}"
        )
    names = set()
    for count, path in enumerate(_entries(folder), start=1):
        name = path.relative_to(folder).as_posix()
        if count > ENTRIES_LIMIT:
            raise BundleRefused(
                "too-big",
                f"{folder.name} has {count} entries or more, expected at most {ENTRIES_LIMIT}. "
                f"{AGAIN}",
            )
        if _is_file(path, name):
            names.add(name)
    return names


def _entries(folder: Path) -> Iterator[Path]:
    for here, folders, files in os.walk(folder):
        yield from (Path(here, name) for name in (*folders, *files))


def _is_file(path: Path, name: str) -> bool:
    """Return whether an entry is a file, False for a folder; refuse all else and what is big."""
    found = path.lstat()
    if stat.S_ISDIR(found.st_mode):
        return False
    if not stat.S_ISREG(found.st_mode):
        raise BundleRefused("path", f"{name!r} is a link or device, expected a file. {AGAIN}")
    limit = SIZE_LIMITS.get(name, OTHER_LIMIT)
    if found.st_size > limit:
        raise BundleRefused(
            "too-big", f"{name!r} has {found.st_size} bytes, expected at most {limit}. {AGAIN}"
        )
    return True


def check_files(folder: Path, present: set[str], manifest: Manifest) -> None:
    """Require that exactly the listed files are there, each unchanged.

    Raises:
        BundleRefused: `path`, `files` or `digest`.
    """
    listed = [subject.name for subject in manifest.subject]
    for name in listed:
        if not NAME.fullmatch(name):
            raise BundleRefused(
                "path", f"manifest.json lists {name!r}, expected a plain name inside. {AGAIN}"
            )
    folded = [name.casefold() for name in listed]
    twice = sorted({name for name in listed if folded.count(name.casefold()) > 1})
    if twice:
        raise BundleRefused(
            "path", f"manifest.json lists {twice}, expected names that differ in letters. {AGAIN}"
        )
    absent = sorted({*listed, *REQUIRED} - present)
    unlisted = sorted(present - {*listed, "manifest.json"})
    unknown = sorted(name for name in listed if not KNOWN.fullmatch(name))
    if absent or unlisted or unknown or not set(listed) >= REQUIRED:
        raise BundleRefused(
            "files",
            f"listed but absent: {absent}; present but not listed: {unlisted}; of no known kind: "
            f"{unknown}; expected the files that manifest.json lists. {AGAIN}",
        )
    for subject in manifest.subject:
        found = sha256(folder / subject.name)
        expect("digest", subject.name, "sha256", found, subject.digest.sha256)
