"""Where recorded bundles stand: swapped in whole by renames, set right after a kill."""

import os
import shutil
from pathlib import Path

from robo_genesis.core.files import NEXT, OLD, beside, settle, swap
from robo_genesis.core.project import ProjectError

HIDDEN = "."
"""How the next and the old state of a bundle begin, so that neither is taken for a bundle."""


def require_folder(evidence: Path) -> None:
    """Raise ProjectError, before a long run, where no bundle could be put in the end."""
    there = next(path for path in (evidence, *evidence.parents) if path.exists())
    if not there.is_dir() or not os.access(there, os.W_OK):
        raise ProjectError(
            f"{evidence} cannot hold evidence: {there} is no folder that you may write. "
            "Name another with TO=folder, or give write access."
        )


def put(bundle: Path, lesson: Path) -> Path:
    """Put a bundle into its lesson's folder under its own name, in the place of an older one.

    Args:
        bundle: the accepted bundle, named by its actual backend.
        lesson: the folder of the lesson's recorded bundles.

    Returns:
        Where it stands.

    Raises:
        ProjectError: something that is no bundle stands there.
        OSError: nothing is changed.
    """
    place = lesson / bundle.name
    if place.is_symlink() or (place.exists() and not (place / "manifest.json").is_file()):
        raise ProjectError(
            f"{place} is no evidence bundle: it has no manifest.json, or is a link. "
            "Move it away, or name another folder with TO=folder."
        )
    try:
        shutil.copytree(bundle, beside(place, NEXT, HIDDEN))
        swap(place, HIDDEN)
    finally:
        recover(lesson.parent)
    return place


def recover(evidence: Path) -> None:
    """Bring recorded evidence into order after a command that was killed; see `publish.settle`.

    Args:
        evidence: the folder of all recorded bundles.
    """
    for suffix in (OLD, NEXT):
        for left in evidence.glob(f"*/{HIDDEN}*{suffix}"):
            settle(left.with_name(left.stem.removeprefix(HIDDEN)), HIDDEN)
