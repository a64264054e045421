"""The copy of a checkout holds what the working tree holds, whatever its files are called."""

import os
import subprocess
from pathlib import Path

import pytest

from robo_genesis.project import ProjectError
from robo_genesis.workcopy import copy_tree, run_logged


def git(folder: Path, *words: str) -> None:
    own = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "protocol.file.allow=always"]
    command = ["git", "-C", str(folder), *own, *words]
    subprocess.run(command, check=True, capture_output=True)


def repository(folder: Path) -> Path:
    folder.mkdir()
    git(folder, "init", "--quiet")
    (folder / "file.txt").write_text("committed\n")
    git(folder, "add", ".")
    git(folder, "commit", "--quiet", "-m", "a")
    return folder


@pytest.fixture
def root(tmp_path) -> Path:
    return repository(tmp_path / "checkout")


def copied(root: Path) -> Path:
    copy_tree(root, root.parent / "work", root.parent / "cache")
    return root.parent / "work"


def test_a_name_that_is_not_utf_8_is_copied_like_any_other(root):
    name = os.fsdecode(b"na\xefve.txt")
    (root / name).write_text("new\n")
    assert (copied(root) / name).read_text() == "new\n"


def test_a_repository_within_the_checkout_is_refused_by_name_before_anything_is_copied(root):
    repository(root / "nested")
    with pytest.raises(ProjectError, match=r"holds other repositories: nested/\. .* \.gitignore"):
        copied(root)
    assert not (root.parent / "work").exists()
    (root / ".gitignore").write_text("nested\n")
    assert not (copied(root) / "nested").exists()


def test_a_submodule_is_refused_by_name(root, tmp_path):
    git(root, "submodule", "--quiet", "add", str(repository(tmp_path / "other")), "part")
    with pytest.raises(ProjectError, match=r"holds other repositories: part\. "):
        copied(root)


def test_a_folder_in_place_of_a_committed_file_is_copied_with_what_is_in_it(root):
    (root / "file.txt").unlink()
    (root / "file.txt").mkdir()
    (root / "file.txt" / "inner.txt").write_text("new\n")
    assert (copied(root) / "file.txt" / "inner.txt").read_text() == "new\n"


def test_a_command_of_the_copy_gets_no_wish_that_was_meant_for_the_outer_make(
    tmp_path, monkeypatch
):
    wishes = {"RELEASE", "BUNDLE", "GENESIS", "PYTHON", "MAKEFLAGS"}
    for name in (*wishes, "JOBS"):
        monkeypatch.setenv(name, "given")
    run_logged(["env"], tmp_path, tmp_path / "log")
    found = {line.partition("=")[0] for line in (tmp_path / "log").read_text().splitlines()}
    assert "JOBS" in found
    assert not found & wishes
