"""The package as a wheel: the same files give the same bytes, without the network."""

import os
import shutil
import subprocess
import sys
import tempfile
from itertools import chain
from pathlib import Path

from robo_genesis.core.content_cache import derived
from robo_genesis.core.project import CACHE, ROOT, ProjectError

SOURCES = ("pyproject.toml", "README.md", "LICENSE")
PACKAGE = "robo_genesis"
EPOCH = "315532800"
"""1980-01-01, the oldest time that a zip can hold."""

BUILD = "import sys; from setuptools import build_meta; print(build_meta.build_wheel(sys.argv[1]))"


def stored_wheel(folder: Path, root: Path = ROOT, cache: Path = CACHE) -> Path:
    """Put the wheel into a folder and return its path; built only where its sources changed.

    Args:
        folder: gets the wheel.
        root: the checkout.
        cache: the cache folder.

    Raises:
        ProjectError: setuptools refused; the message holds what it said.
    """
    sources = [root / name for name in SOURCES]
    sources += sorted(path for path in (root / PACKAGE).rglob("*") if path.suffix != ".pyc")

    def build() -> bytes:
        with tempfile.TemporaryDirectory() as name:
            wheel = build_wheel(Path(name), root)
            return wheel.name.encode() + b"\n" + wheel.read_bytes()

    names = (path.relative_to(root).as_posix().encode() for path in sources)
    contents = (path.read_bytes() for path in sources if path.is_file())
    stored = derived("wheel", chain(names, contents), build, cache)
    name, _, content = stored.partition(b"\n")
    wheel = folder / name.decode()
    wheel.write_bytes(content)
    return wheel


def build_wheel(folder: Path, root: Path = ROOT) -> Path:
    """Build the wheel and return its path.

    Args:
        folder: gets the wheel.
        root: the checkout, which stays as it is: the build works in a copy.

    Raises:
        ProjectError: setuptools refused; the message holds what it said.
    """
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name)
        for source in SOURCES:
            shutil.copy(root / source, copy)
        leave = shutil.ignore_patterns("__pycache__")
        shutil.copytree(root / PACKAGE, copy / PACKAGE, ignore=leave)
        for path in copy.rglob("*"):
            path.chmod(0o755 if path.is_dir() else 0o644)  # whatever the user's umask
        done = subprocess.run(
            [sys.executable, "-c", BUILD, str(folder.resolve())],
            cwd=copy,
            env=os.environ | {"SOURCE_DATE_EPOCH": EPOCH},
            capture_output=True,
            text=True,
            check=False,
        )
    if done.returncode != 0:
        raise ProjectError(f"The package's wheel cannot be built:\n{done.stdout}{done.stderr}")
    return folder / done.stdout.splitlines()[-1]
