"""Copies of the checkout, for tests that change its files."""

import shutil
import subprocess
import sys
from pathlib import Path

from robo_genesis.core.git import git
from robo_genesis.core.project import ROOT
from robo_genesis.pipeline.release import environment


def copy_checkout(work: Path) -> Path:
    """Copy every file of the checkout that git does not ignore."""
    listed = git(ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard")
    for file in filter(None, listed.split("\0")):
        if (ROOT / file).is_file():
            (work / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / file, work / file)
    return work


def run_in(work: Path, *command: str) -> str:
    """Run a command in a copy, with no flag of an outer make."""
    given = environment(work) | {"PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(command, cwd=work, env=given, capture_output=True, text=True)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    return said


def make(work: Path, *words: str) -> str:
    """Run make in a copy, with this interpreter."""
    return run_in(work, "make", *words, f"PYTHON={sys.executable}")
