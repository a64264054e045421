"""The evidence that `make book RELEASE=1` requires in addition to a build and a clean tree."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from robo_genesis.core.git import git
from robo_genesis.evidence.bundle import GitRecord
from robo_genesis.evidence.status import Status, bundle_status, recorded_folders, recorded_status
from robo_genesis.lessons.registry import find_lesson


def missing_for_release(book: Path, built: Mapping[str, Path | None], root: Path) -> list[str]:
    """Return a line for each requirement of a release that the evidence of a book does not meet.

    A lesson requires the evidence of its minimum hardware: this build's if that is the CPU, else
    the recorded one. Other recorded bundles may be missing or stale, but a bundle that is shown
    comes from one commit.

    Args:
        book: the folder of the pages.
        built: the folder of the lab's bundle of this build, by lesson of the book; None for a
            lesson without a lab.
        root: the checkout that the build's bundles must name.
    """
    lines = [line for lesson in built for line in _required(book, lesson, built[lesson], root)]
    for path in recorded_folders(book):
        lines += _of_commit(f"{path.relative_to(book)}", recorded_status(book, *path.parts[-2:]))
    return lines


def _required(book: Path, lesson: str, folder: Path | None, root: Path) -> Iterator[str]:
    if folder is None:
        yield f"{lesson} has no lab in the table of contents, so this build measures nothing of it."
        return
    here = bundle_status(folder, lesson, "lab", book=book)
    hardware = find_lesson(lesson).spec.MINIMUM_HARDWARE
    needed = here if hardware == here.backend else recorded_status(book, lesson, hardware)
    if needed.state != "verified":
        yield (
            f"{lesson} requires evidence of its minimum hardware, {hardware}, which is "
            f"{needed.state}: {needed.reason}"
        )
    if here.manifest is not None:
        commit = git(root, "rev-parse", "HEAD").strip()
        yield from _of_commit(f"{lesson} on {here.backend}, this build", here, commit)


def _of_commit(what: str, status: Status, commit: str | None = None) -> Iterator[str]:
    """Yield why a shown bundle was not made from one commit."""
    if status.manifest is None:
        return
    git: GitRecord | None = status.manifest.predicate.git
    if git is None or git.dirty:
        found = "outside a git checkout" if git is None else f"from a changed tree ({git.commit})"
        yield f"{what}: recorded {found}. Commit first, then record again."
    elif commit is not None and git.commit != commit:
        yield f"{what}: recorded at commit {git.commit}, the tree is at {commit}. Build again."
