"""Folders are replaced whole or not at all, and only where they are of the expected kind."""

import subprocess
import sys

import pytest
from tiny_book import old_bundle

from robo_genesis.core.files import settle_below
from robo_genesis.core.project import ROOT

DIES = """
import os, sys
from pathlib import Path
from robo_genesis.core import files
rename, done = os.rename, []
def dying(*paths):
    if len(done) == {renames}:
        os._exit(9)
    done.append(rename(*paths))
os.rename = dying
remove = files.shutil.rmtree
files.shutil.rmtree = lambda path: os._exit(9) if {renames} == 2 else remove(path)
files.put(Path(sys.argv[1]), Path(sys.argv[2]))
"""


@pytest.mark.parametrize(("renames", "stands"), [(0, "old"), (1, "old"), (2, "new")])
def test_a_kill_at_any_rename_leaves_the_old_or_the_new_bundle(
    tmp_path, renames, stands
):
    old, new = old_bundle(tmp_path, "cuda"), tmp_path / "run" / "cuda"
    new.mkdir(parents=True)
    (new / "manifest.json").write_text("{}")
    (new / "log.txt").write_text("new")
    command = [
        sys.executable,
        "-c",
        DIES.format(renames=renames),
        str(new),
        str(old.parent),
    ]
    assert subprocess.run(command, check=False, cwd=ROOT).returncode == 9
    assert (
        len(list(old.parents[1].iterdir())) == 2
    )  # one stands aside, or is not yet whole
    settle_below(tmp_path / "kept")
    assert [path.name for path in old.parents[1].iterdir()] == ["cuda"]
    assert old.read_text() == stands
    assert (old.parent / "of the old one.txt").exists() == (stands == "old")
