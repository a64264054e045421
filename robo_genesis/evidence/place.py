"""Where recorded bundles stand: swapped in whole by renames, set right after a kill."""

import os
import shutil
from pathlib import Path

from robo_genesis.project import ProjectError

NEXT, OLD = ".next", ".old"


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
    following, aside = _beside(place, NEXT), _beside(place, OLD)
    try:
        shutil.copytree(bundle, following)
        if place.exists():
            os.rename(place, aside)
        os.rename(following, place)
    finally:
        recover(lesson.parent)
    return place


def recover(evidence: Path) -> None:
    """Bring recorded evidence into order after a command that was killed.

    Killed between the two renames, the old bundle stands aside: it comes back. Killed earlier or
    later, what is left is rubbish.

    Args:
        evidence: the folder of all recorded bundles.
    """
    for aside in evidence.glob(f"*/.*{OLD}"):
        place = aside.with_name(aside.name.removeprefix(".").removesuffix(OLD))
        if place.exists():
            shutil.rmtree(aside)
        else:
            aside.rename(place)
    for folder in evidence.glob(f"*/.*{NEXT}"):
        shutil.rmtree(folder)


def _beside(place: Path, suffix: str) -> Path:
    return place.with_name(f".{place.name}{suffix}")
