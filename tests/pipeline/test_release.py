"""A release is one commit with all required evidence; everything else is named and refused."""

import shutil
from pathlib import Path

import pytest
from spoilers import predicate, seal
from test_status import spoil_stale
from tiny_book import commit, git

from robo_genesis.core.git import unclean
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.pipeline.release import missing_for_release


@pytest.fixture
def checkout(tmp_path) -> Path:
    root = tmp_path / "checkout"
    root.mkdir()
    (root / "page.md").write_text("A page.\n")
    commit(root)
    return root


@pytest.fixture
def built(folder, checkout) -> dict[str, Path]:
    """A bundle that this commit's build left."""
    recorded_at(folder, git(checkout, "rev-parse", "HEAD").strip())
    return {"l04": folder}


def recorded_at(folder: Path, commit: str | None, dirty: bool = False) -> None:
    """Let a bundle say at which state of the checkout it was recorded."""
    predicate(git=commit and {"commit": commit, "dirty": dirty})(folder)
    seal(folder)


def missing(book: Path, built: dict[str, Path | None], root: Path) -> list[str]:
    manifests = {f"{name}/lab": read_manifest(at) for name, at in built.items() if at}
    return missing_for_release(
        book, built, manifests, git(root, "rev-parse", "HEAD").strip()
    )


@pytest.fixture
def book(tmp_path, courses_pages) -> Path:
    return tmp_path / "book"


def test_a_clean_commit_with_its_own_evidence_lacks_nothing(checkout, built, book):
    assert unclean(checkout) == []
    assert missing(book, built, checkout) == []
    git(
        checkout, "config", "status.showUntrackedFiles", "no"
    )  # whatever the user's git shows
    (checkout / "new.md").write_text("New.\n")
    assert "new.md" in unclean(checkout)[0]


@pytest.mark.parametrize(
    ("hardware", "has_lab", "said"),
    [
        ("cpu", False, "l04 has no lab in the table of contents"),
        (
            "cpu",
            True,
            "l04 requires evidence of its minimum hardware, cpu, which is stale: ",
        ),
        (
            "amdgpu",
            True,
            "l04 requires evidence of its minimum hardware, amdgpu, which is missing",
        ),
    ],
)
def test_lacking_evidence_is_named(
    checkout, built, book, monkeypatch, hardware, has_lab, said
):
    monkeypatch.setattr(l04, "MINIMUM_HARDWARE", hardware)
    if hardware == "cpu":
        spoil_stale(built["l04"])
    [line] = missing(book, built if has_lab else {"l04": None}, checkout)
    assert line.startswith(said)


@pytest.mark.parametrize(
    ("commit", "dirty", "said"),
    [
        ("1" * 40, False, "recorded at commit 1111"),
        ("1" * 40, True, "recorded from a changed tree (1111"),
        (None, False, "recorded outside a git checkout"),
    ],
)
def test_evidence_of_another_state_of_the_tree_is_named(
    checkout, built, book, commit, dirty, said
):
    recorded_at(built["l04"], commit, dirty)
    [line] = missing(book, built, checkout)
    assert line.startswith("l04/lab, this build: ")
    assert said in line


def test_of_recordings_only_those_of_a_changed_tree_stop_a_release(
    checkout, built, book
):
    recorded = shutil.copytree(built["l04"], book / "evidence" / "l04" / "cpu")
    recorded_at(recorded, "1" * 40)
    assert missing(book, built, checkout) == []
    recorded_at(recorded, "1" * 40, dirty=True)
    [line] = missing(book, built, checkout)
    assert line.startswith("evidence/l04/cpu: recorded from a changed tree")
    spoil_stale(recorded)
    assert missing(book, built, checkout) == []
