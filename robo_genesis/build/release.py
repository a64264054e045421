"""What `make book RELEASE=1` asks for beyond a build and a clean tree: current evidence."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from robo_genesis.core.git import git
from robo_genesis.evidence.bundle import GitRecord
from robo_genesis.evidence.status import Status, bundle_status, recorded_folders, recorded_status
from robo_genesis.lessons.registry import find_lesson


def lacking(book: Path, built: Mapping[str, Path | None], root: Path) -> list[str]:
    """Return a line for each thing that the evidence of a book lacks for a release.

    A lesson requires the evidence of its minimum hardware. Where that is the CPU it is this
    build's; else it is the recorded one. What is recorded beyond that may be missing or stale, but
    if it is shown, it comes from a commit.

    Args:
        book: the folder of the pages.
        built: each lesson of the book to the folder of this build's bundle of its lab, None where
            it has no lab.
        root: the checkout that the build's bundles must name.
    """
    return [
        *(line for lesson in built for line in _required(book, lesson, built[lesson], root)),
        *(line for path in recorded_folders(book) for line in _recorded(book, path)),
    ]


def _required(book: Path, lesson: str, folder: Path | None, root: Path) -> Iterator[str]:
    if folder is None:
        yield f"{lesson} has no lab in the table of contents, so nothing of it is measured for it."
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


def _recorded(book: Path, path: Path) -> Iterable[str]:
    status = recorded_status(book, *path.parts[-2:])
    return _of_commit(f"{path.relative_to(book)}", status)


def _of_commit(what: str, status: Status, commit: str | None = None) -> Iterator[str]:
    """Yield why a bundle that is shown was not made from one commit."""
    if status.manifest is None:
        return
    git: GitRecord | None = status.manifest.predicate.git
    if git is None or git.dirty:
        found = "outside a git checkout" if git is None else f"from a changed tree ({git.commit})"
        yield f"{what}: recorded {found}. Commit first, then record again."
    elif commit is not None and git.commit != commit:
        yield f"{what}: recorded at commit {git.commit}, the tree is at {commit}. Build again."
