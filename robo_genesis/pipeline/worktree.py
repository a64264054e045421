"""A second checkout of the last commit, and commands in it that ignore the outer make."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from robo_genesis.core.git import git, git_or_none
from robo_genesis.core.project import COMPILED, STORE

SHARED = ("derived", COMPILED, "npm", STORE)
"""Caches that the worktree shares with the checkout: their folders are named by their inputs."""

OUTER = (
    "GENESIS", "PYTHON", "BUNDLE", "RELEASE", "EXECUTED", "MAKEFLAGS", "MFLAGS", "MAKELEVEL",
    "PYTEST_ADDOPTS",
)  # fmt: skip
"""Variables of the outer make that a make in another checkout must not get: a new pin makes
recorded bundles stale, which a release would refuse."""


def environment(work: Path, *without: str) -> dict[str, str]:
    """Return the variables for a command in a worktree: those of this process, with fewer names."""
    kept = {name: os.environ[name] for name in os.environ.keys() - {*OUTER, *without}}
    return kept | {"PYTHONPATH": str(work)}


@contextmanager
def worktree(root: Path, work: Path, cache: Path) -> Iterator[Path]:
    """Check the last commit out in a worktree with shared caches; remove it in the end.

    Args:
        root: the checkout.
        work: the folder of the worktree.
        cache: the folder of the caches.

    Raises:
        ProjectError: git cannot make it.
    """
    remove(root, work)  # of a run that was killed
    try:
        git(root, "worktree", "add", "--detach", str(work), "HEAD")
        (work / ".cache").mkdir()
        for name in SHARED:
            (cache / name).mkdir(parents=True, exist_ok=True)
            (work / ".cache" / name).symlink_to(cache / name)
        yield work
    finally:
        remove(root, work)


def remove(root: Path, work: Path) -> None:
    """Remove a worktree and git's record of it, a locked one included.

    `git worktree prune` would keep the record of one whose making was killed, and forget worktrees
    of the user on a disk that is not mounted.
    """
    shutil.rmtree(work, ignore_errors=True)
    git_or_none(root, "worktree", "remove", "--force", "--force", str(work))
