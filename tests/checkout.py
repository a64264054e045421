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


def run_in(work: Path, *command: str, fails: bool = False) -> str:
    """Run a command in a copy, with no flag of an outer make; `python` is this interpreter."""
    words = [sys.executable if word == "python" else word for word in command]
    given = environment(work) | {"PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(words, cwd=work, env=given, capture_output=True, text=True)
    said = done.stdout + done.stderr
    assert (done.returncode != 0) == fails, said
    return said


def make(work: Path, *words: str, fails: bool = False) -> str:
    """Run make in a copy, with this interpreter."""
    return run_in(work, "make", *words, f"PYTHON={sys.executable}", fails=fails)


def unit_tests(
    work: Path, *places: str, marks: str = "not engine and not browser"
) -> str:
    """Run tests of a copy."""
    options = ("-q", "-p", "no:cacheprovider", "-m", marks)
    return run_in(work, "python", "-m", "pytest", *options, *places)


def import_contracts(work: Path) -> str:
    """Check the import contracts of a copy."""
    command = (
        "from importlinter.cli import lint_imports_command; lint_imports_command()"
    )
    return run_in(work, "python", "-c", command, "--no-logo", "--no-cache")
