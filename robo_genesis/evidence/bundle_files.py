"""Checks of the files of a bundle before any is read: kind, number, size, list and digests."""

import os
import re
import stat
from pathlib import Path
from typing import Any

from robo_genesis.evidence.bundle import PRINTED, Manifest, sha256
from robo_genesis.evidence.refusals import expect, unexpected

MANIFEST = "manifest.json"
MIB = 2**20
SIZE_LIMITS = dict.fromkeys((MANIFEST, "metrics.json", "arrays.json"), MIB)
SIZE_LIMITS |= {"log.txt": 4 * MIB, PRINTED: 4 * MIB}
OTHER_LIMIT = 16 * MIB
"""Bytes of one archive or picture. Those of a lesson have less than 0.1 MiB."""

ENTRIES_LIMIT = 200
REQUIRED = {"metrics.json", "arrays.json", "log.txt"}
KNOWN = re.compile(
    r"(metrics|arrays|printed)\.json|log\.txt|arrays/\w+\.npz|frames/\w+\.png"
)


def scan(folder: Path) -> set[str]:
    """Return the names of the files of a bundle after checking the kind, number and size of each.

    Nothing is opened: a link, a pipe or a huge file is refused before it can do harm.

    Raises:
        BundleRefused: `missing-file`, `path` or `too-big`.
    """
    if folder.is_symlink():
        raise unexpected("path", folder.name, "the bundle", "a link", "a folder")
    if not os.path.lexists(folder / MANIFEST):
        raise unexpected("missing-file", folder.name, MANIFEST, "missing", "a file")
    names = set()
    for count, path in enumerate(folder.rglob("*"), start=1):
        name, found = path.relative_to(folder).as_posix(), path.lstat()
        limit = SIZE_LIMITS.get(name, OTHER_LIMIT)
        if count > ENTRIES_LIMIT:
            most = f"at most {ENTRIES_LIMIT}"
            raise unexpected("too-big", folder.name, "number of entries", count, most)
        if stat.S_ISDIR(found.st_mode):
            continue
        if not stat.S_ISREG(found.st_mode):
            raise unexpected("path", name, "it", "a link or device", "a file")
        if found.st_size > limit:
            raise unexpected(
                "too-big", name, "number of bytes", found.st_size, f"at most {limit}"
            )
        names.add(name)
    return names


def list_files(folder: Path) -> list[dict[str, Any]]:
    """Return the list in a manifest: each other file of a bundle with its digest."""
    return [
        {
            "name": path.relative_to(folder).as_posix(),
            "digest": {"sha256": sha256(path)},
        }
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != MANIFEST
    ]


def check_files(folder: Path, present: set[str], manifest: Manifest) -> None:
    """Require that the files are exactly the listed ones, with the listed digests.

    Raises:
        BundleRefused: `files` or `digest`.
    """
    listed = [subject.name for subject in manifest.subject]
    for what, wrong in (
        ("listed, but absent", {*listed, *REQUIRED} - present),
        ("not listed", present - {*listed, MANIFEST}),
        ("of unknown kind", {name for name in listed if not KNOWN.fullmatch(name)}),
    ):
        expect("files", MANIFEST, f"list of files that are {what},", sorted(wrong), [])
    for subject in manifest.subject:
        found = sha256(folder / subject.name)
        expect("digest", subject.name, "sha256", found, subject.digest.sha256)
