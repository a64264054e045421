"""Recorded bundles on disk: replaced in one move, and repaired after a killed command."""

import os
import shutil
from pathlib import Path

from robo_genesis.core.files import NEXT, OLD, replaced, settle
from robo_genesis.core.project import ProjectError

HIDDEN = "."
"""Prefix of the next and the old state of a bundle, which must not look like bundles."""


def require_folder(evidence: Path) -> None:
    """Raise ProjectError, before a long run, if no bundle could be written into a folder."""
    parent = next(path for path in (evidence, *evidence.parents) if path.exists())
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise ProjectError(
            f"{evidence} cannot hold evidence: {parent} is not a folder that you may write. "
            "Name another with TO=folder, or give write access."
        )


def put(bundle: Path, lesson: Path) -> Path:
    """Copy a bundle into the folder of its lesson; an older bundle of its name is replaced.

    Args:
        bundle: the accepted bundle, named after its actual backend.
        lesson: the folder of the lesson's recorded bundles.

    Returns:
        The folder of the copy.

    Raises:
        ProjectError: the place is taken by something that is not a bundle.
        OSError: the copy failed; nothing has changed.
    """
    place = lesson / bundle.name
    if place.is_symlink() or (place.exists() and not (place / "manifest.json").is_file()):
        raise ProjectError(
            f"{place} is not an evidence bundle: it has no manifest.json, or is a link. "
            "Move it away, or name another folder with TO=folder."
        )
    with replaced(place, HIDDEN) as following:
        shutil.copytree(bundle, following)
    return place


def recover(evidence: Path) -> None:
    """Repair the folder of all recorded bundles after a killed command; see `files.settle`."""
    for suffix in (OLD, NEXT):
        for left in evidence.glob(f"*/{HIDDEN}*{suffix}"):
            settle(left.with_name(left.stem.removeprefix(HIDDEN)), HIDDEN)
