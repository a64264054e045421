"""The package as a wheel, built without the network: the same files give the same bytes."""

import os
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

from robo_genesis.build.kernels import end_with_parent
from robo_genesis.core.project import ROOT, ProjectError

SOURCES = ("pyproject.toml", "README.md", "LICENSE")
PACKAGE = "robo_genesis"
EPOCH = "315532800"
"""1980-01-01, the oldest time that a zip can hold."""

BUILD = "import sys; from setuptools import build_meta; print(build_meta.build_wheel(sys.argv[1]))"


@cache
def build_wheel(folder: Path, root: Path = ROOT) -> Path:
    """Build the wheel and return its path; the labs of one site share it.

    Args:
        folder: gets the wheel.
        root: the checkout, which stays as it is: the build works in a copy.

    Raises:
        ProjectError: setuptools failed; the message contains its output.
    """
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name)
        for source in SOURCES:
            shutil.copy(root / source, copy)
        shutil.copytree(
            root / PACKAGE, copy / PACKAGE, ignore=shutil.ignore_patterns("__pycache__")
        )
        for path in copy.rglob("*"):
            path.chmod(0o755 if path.is_dir() else 0o644)  # whatever the user's umask
        done = subprocess.run(
            [sys.executable, "-c", BUILD, str(folder.resolve())],
            cwd=copy,
            env=os.environ | {"SOURCE_DATE_EPOCH": EPOCH},
            capture_output=True,
            text=True,
            check=False,
            preexec_fn=end_with_parent(),
        )
    if done.returncode != 0:
        raise ProjectError(f"The package's wheel cannot be built:\n{done.stdout}{done.stderr}")
    return folder / done.stdout.splitlines()[-1]
