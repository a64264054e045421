"""The evidence that `make book RELEASE=1` requires in addition to a build and a clean tree."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from robo_genesis.evidence.bundle import GitRecord, Manifest
from robo_genesis.lessons import find_lesson
from robo_genesis.pipeline.bundles.status import (
    bundle_status,
    recorded_folders,
    recorded_status,
)


def missing_for_release(
    book: Path,
    built: Mapping[str, Path | None],
    manifests: Mapping[str, Manifest],
    commit: str,
) -> list[str]:
    """Return a line for each requirement of a release that the evidence of a book does not meet.

    A lesson requires the evidence of its minimum hardware: this build's if that is the
        CPU, else
    the recorded one. Other recorded bundles may be missing or stale, but a bundle that
    is shown comes from one commit.

    Args:
        book: the folder of the pages.
        built: the folder of the lab's bundle of this build, by lesson of the book; None
            for a lesson without a lab.
        manifests: the manifests of all bundles of this build, by page.
        commit: the one that the build's bundles must name.
    """
    lines = [
        line for lesson, at in built.items() for line in _required(book, lesson, at)
    ]
    for page, manifest in manifests.items():
        lines += _of_commit(f"{page}, this build", manifest, commit)
    for path in recorded_folders(book):
        recorded = recorded_status(book, *path.parts[-2:], labs=built)
        lines += _of_commit(f"{path.relative_to(book)}", recorded.manifest)
    return lines


def _required(book: Path, lesson: str, folder: Path | None) -> Iterator[str]:
    if folder is None:
        yield f"{lesson} has no lab in the table of contents, so this build measures nothing of it."
        return
    here = bundle_status(folder, lesson, "lab", book=book)
    hardware = find_lesson(lesson).spec.MINIMUM_HARDWARE
    needed = here
    if hardware != here.backend:
        needed = recorded_status(book, lesson, hardware, labs={lesson: folder})
    if needed.state != "verified":
        yield (
            f"{lesson} requires evidence of its minimum hardware, {hardware}, which is "
            f"{needed.state}: {needed.reason}"
        )


def _of_commit(
    what: str, manifest: Manifest | None, commit: str | None = None
) -> Iterator[str]:
    """Yield why a shown bundle was not made from one commit."""
    if manifest is None:
        return
    git: GitRecord | None = manifest.predicate.git
    if git is None or git.dirty:
        found = (
            "outside a git checkout"
            if git is None
            else f"from a changed tree ({git.commit})"
        )
        yield f"{what}: recorded {found}. Commit first, then record again."
    elif commit is not None and git.commit != commit:
        yield f"{what}: recorded at commit {git.commit}, the tree is at {commit}. Build again."
