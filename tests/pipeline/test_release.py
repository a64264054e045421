"""A release is one commit with all required evidence; what is lacking is named."""

import shutil
from argparse import Namespace
from pathlib import Path

import pytest
from spoilers import facts, older_compiler, seal
from tiny_book import commit, git

from robo_genesis.core.project import BOOK, ROOT, ProjectError
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.pipeline import release
from robo_genesis.pipeline.release import missing_for_release, worktree

MAIN = """
import os, sys
from pathlib import Path
page = Path("page.md").read_text()
place, options = Path({found!r}), " ".join(sys.argv[1:])
place.write_text(page + options + os.environ["PYTHONPATH"])
sys.exit(page != "committed")
"""


@pytest.fixture
def root(tmp_path) -> Path:
    """A checkout whose command `book` says what it found."""
    root = tmp_path / "a checkout"
    (root / "robo_genesis").mkdir(parents=True)
    main = MAIN.format(found=str(tmp_path / "found"))
    (root / "robo_genesis" / "__main__.py").write_text(main)
    (root / "page.md").write_text("committed")
    (root / ".gitignore").write_text("/.cache\n__pycache__/\n")
    commit(root)
    return root


@pytest.fixture
def build(root, monkeypatch):
    monkeypatch.setattr(release, "ROOT", root)
    settings = {"render": "1", "jobs": 2, "site_url": "", "solutions": "0"}
    options = Namespace(book=BOOK, cache=root / ".cache", timeout=9, **settings)
    return lambda: release.build(options)


def test_a_release_is_built_from_the_commit_with_its_own_code(root, build):
    (root / "page.md").write_text("changed")
    (root / ".cache" / "engine").mkdir(parents=True)
    with pytest.raises(ProjectError, match=r"1 changed or new files \(page\.md\)"):
        build()
    git(root, "stash")
    (root / ".cache" / "release").mkdir()  # of a release that was killed
    assert build() == 0
    tree = root / ".cache" / "release"
    found = (root.parent / "found").read_text()
    assert found.startswith("committedbook --release=1 --render=1 --jobs=2")
    assert f"--to={BOOK}{tree}" in found
    assert not tree.exists()
    assert (root / ".cache" / "engine").is_dir()


def test_a_release_that_fails_leaves_its_worktree_for_the_report(root, build):
    (root / "page.md").write_text("wrong")
    commit(root)
    with pytest.raises(ProjectError, match="The release failed"):
        build()
    assert (root / ".cache" / "release" / "page.md").is_file()


def test_two_users_of_a_worktree_are_refused(root):
    folder = root / ".cache" / "work"
    with (
        worktree(root, folder, root / ".cache", ()),
        pytest.raises(ProjectError, match="Another user of"),
        worktree(root, folder, root / ".cache", ()),
    ):
        pass


def test_no_setting_of_git_changes_the_bytes_of_a_checkout(root, tmp_path):
    shutil.copy(ROOT / ".gitattributes", root)
    commit(root)
    git(tmp_path, "-c", "core.autocrlf=true", "clone", "--quiet", str(root), "clone")
    assert (tmp_path / "clone/.gitignore").read_bytes() == b"/.cache\n__pycache__/\n"


@pytest.fixture
def book(tmp_path, courses_pages) -> Path:
    return tmp_path / "book"


@pytest.mark.parametrize(
    ("hardware", "state"), [("cpu", "stale"), ("amdgpu", "missing")]
)
def test_lacking_evidence_is_named(folder, book, monkeypatch, hardware, state):
    assert missing_for_release(book, {"l04": folder}) == []
    monkeypatch.setattr(l04, "MINIMUM_HARDWARE", hardware)
    if hardware == "cpu":
        older_compiler(folder)
    [line] = missing_for_release(book, {"l04": folder})
    said = (
        f"l04 requires evidence of its minimum hardware, {hardware}, which is {state}"
    )
    assert line.startswith(said)


@pytest.mark.parametrize(("dirty", "stops"), [(False, False), (True, True)])
def test_a_recording_of_a_changed_tree_stops_a_release(folder, book, dirty, stops):
    recorded = shutil.copytree(folder, book / "evidence" / "l04" / "cpu")
    facts(git={"commit": "1" * 40, "dirty": dirty})(recorded)
    seal(recorded)
    lines = missing_for_release(book, {"l04": folder})
    assert [line.partition(" was")[0] for line in lines] == ["evidence/l04/cpu"] * stops
