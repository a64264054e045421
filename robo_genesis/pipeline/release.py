"""`make book RELEASE=1`: the last commit is built in a worktree, with all required evidence."""

import os
import shutil
import subprocess
import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from robo_genesis.core.files import locked
from robo_genesis.core.git import git, require_clean
from robo_genesis.core.project import BOOK, COMPILED, ROOT, ProjectError
from robo_genesis.lessons import find_lesson

from .bundles.status import (
    bundle_status,
    recorded_folders,
    recorded_status,
)
from .command import end_with_parent

# Variables of a surrounding make, which a make in a worktree must not get.
OUTER = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS", "PYTHON", "GENESIS", "RELEASE"}


@contextmanager
def worktree(
    root: Path, folder: Path, cache: Path, shared: Sequence[str]
) -> Iterator[Path]:
    """Check the last commit out in a worktree of git; it is removed unless an error occurs.

    Args:
        root: the checkout, which must have no changes.
        folder: of the worktree. What a failed run left there is removed first.
        cache: the folder of the caches.
        shared: the names of the caches that the worktree uses as well.

    Raises:
        ProjectError: the checkout has changes or is not one, or another process uses the folder.
    """
    require_clean(root)
    with locked(folder.with_suffix(".lock"), f"Another user of {folder}"):
        remove(root, folder)
        git(root, "worktree", "add", "--quiet", "--detach", str(folder), "HEAD")
        (folder / ".cache").mkdir()
        for name in shared:
            (cache / name).mkdir(parents=True, exist_ok=True)
            (folder / ".cache" / name).symlink_to((cache / name).resolve())
        yield folder
        remove(root, folder)


def remove(root: Path, folder: Path) -> None:
    """Remove a worktree, if it exists."""
    shutil.rmtree(folder, ignore_errors=True)
    git(root, "worktree", "prune")


def environment(tree: Path) -> dict[str, str]:
    """Return the variables for a command in a worktree."""
    names = os.environ.keys() - OUTER
    return {name: os.environ[name] for name in names} | {"PYTHONPATH": str(tree)}


def build(options: Namespace) -> int:
    """Build the last commit in a worktree, and return the exit status of that build.

    It executes each page at its commit and shares only what the engine compiled.

    Args:
        options: of the command `book`.

    Raises:
        ProjectError: the tree has changes, or the build failed.
    """
    if options.book != BOOK:
        raise ProjectError(
            f"A release builds the commit's own book, not {options.book}."
        )
    names = ("render", "jobs", "site_url", "solutions", "timeout")
    settings = [
        f"--{name.replace('_', '-')}={getattr(options, name)}" for name in names
    ]
    command = [sys.executable, "-m", "robo_genesis", "book", "--release=1", *settings]
    folder = options.cache / "release"
    with worktree(ROOT, folder, options.cache, (COMPILED, "npm")) as tree:
        process = subprocess.Popen(
            [*command, f"--to={BOOK}"],
            cwd=tree,
            env=environment(tree),
            preexec_fn=end_with_parent(),
        )
        if process.wait():
            raise ProjectError(f"The release failed; {tree} has its logs in .cache.")
    return 0


def missing_for_release(book: Path, labs: Mapping[str, Path]) -> list[str]:
    """Return why the evidence of a book is not that of a release, nothing if it is.

    A lesson requires the evidence of its minimum hardware: this build's if that is the
    CPU, else the recorded one. Other recorded bundles may be missing or stale, but one
    that is shown names a commit.

    Args:
        book: the folder of the pages.
        labs: the folder of the lab's bundle of this build, by lesson of the book.
    """
    lines = [
        line for lesson, at in labs.items() for line in _required(book, lesson, at)
    ]
    for path in recorded_folders(book):
        manifest = recorded_status(book, *path.parts[-2:]).manifest
        if manifest and (not manifest.git or manifest.git.dirty):
            lines.append(
                f"{path.relative_to(book)} was not recorded from a commit. Commit first, "
                "then record again."
            )
    return lines


def _required(book: Path, lesson: str, folder: Path) -> Iterator[str]:
    """Yield why a lesson lacks the evidence of its minimum hardware."""
    status = bundle_status(folder, lesson, "lab", book=book)
    hardware = find_lesson(lesson).spec.MINIMUM_HARDWARE
    if hardware != status.backend:
        status = recorded_status(book, lesson, hardware)
    if status.state != "verified":
        yield (
            f"{lesson} requires evidence of its minimum hardware, {hardware}, which is "
            f"{status.state}: {status.reason}"
        )
