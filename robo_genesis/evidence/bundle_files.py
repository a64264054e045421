"""Checks of the files of a bundle before any is read: kind, number, size, list and digests."""

import os
import re
import stat
from collections import Counter
from pathlib import Path

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence.bundle import Manifest, sha256

MIB = 2**20
SIZE_LIMITS = {"manifest.json": MIB, "metrics.json": MIB, "arrays.json": MIB, "log.txt": 4 * MIB}
OTHER_LIMIT = 16 * MIB
"""Bytes of one archive or picture. Those of a lesson have less than 0.1 MiB."""

ENTRIES_LIMIT = 200
REQUIRED = {"metrics.json", "arrays.json", "log.txt"}
NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*(/[A-Za-z0-9_-][A-Za-z0-9_.-]*)*")
KNOWN = re.compile(r"metrics\.json|arrays\.json|log\.txt|arrays/\w+\.npz|frames/\w+\.png")


def scan(folder: Path) -> set[str]:
    """Return the names of the files of a bundle after checking the kind, number and size of each.

    Nothing is opened: a link, a pipe or a huge file is refused before it can do harm.

    Raises:
        BundleRefused: `missing-file`, `path` or `too-big`.
    """
    if folder.is_symlink():
        raise BundleRefused("path", f"{folder.name} is a link, expected a folder. {AGAIN}")
    if not os.path.lexists(folder / "manifest.json"):
        raise BundleRefused(
            "missing-file", f"{folder.name} has no manifest.json, expected a bundle. {AGAIN}"
        )
    names = set()
    for count, path in enumerate(folder.rglob("*"), start=1):
        name, found = path.relative_to(folder).as_posix(), path.lstat()
        limit = SIZE_LIMITS.get(name, OTHER_LIMIT)
        if count > ENTRIES_LIMIT:
            number = f"has {count} entries or more, expected at most {ENTRIES_LIMIT}"
            raise BundleRefused("too-big", f"{folder.name} {number}. {AGAIN}")
        if stat.S_ISDIR(found.st_mode):
            continue
        if not stat.S_ISREG(found.st_mode):
            raise BundleRefused("path", f"{name!r} is a link or device, expected a file. {AGAIN}")
        if found.st_size > limit:
            size = f"has {found.st_size} bytes, expected at most {limit}"
            raise BundleRefused("too-big", f"{name!r} {size}. {AGAIN}")
        names.add(name)
    return names


def check_files(folder: Path, present: set[str], manifest: Manifest) -> None:
    """Require that the files are exactly the listed ones, with the listed digests.

    Raises:
        BundleRefused: `path`, `files` or `digest`.
    """
    listed = [subject.name for subject in manifest.subject]
    odd = [name for name in listed if not NAME.fullmatch(name)]
    expect("path", "manifest.json", "list of names that are not plain relative paths", odd, [])
    folded = Counter(name.casefold() for name in listed)
    repeated = sorted({name for name in listed if folded[name.casefold()] > 1})
    expect("path", "manifest.json", "list of names that differ at most in case", repeated, [])
    absent = sorted({*listed, *REQUIRED} - present)
    unlisted = sorted(present - {*listed, "manifest.json"})
    unknown = sorted(name for name in listed if not KNOWN.fullmatch(name))
    if absent or unlisted or unknown or not set(listed) >= REQUIRED:
        raise BundleRefused(
            "files",
            f"listed but absent: {absent}; present but not listed: {unlisted}; of unknown kind: "
            f"{unknown}; expected the files that manifest.json lists. {AGAIN}",
        )
    for subject in manifest.subject:
        found = sha256(folder / subject.name)
        expect("digest", subject.name, "sha256", found, subject.digest.sha256)
