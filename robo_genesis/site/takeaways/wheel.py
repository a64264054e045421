"""The package as a wheel, built without the network: the same files give the same bytes."""

import json
import os
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path

from robo_genesis.core.files import derived, write_whole
from robo_genesis.core.project import ROOT
from robo_genesis.pipeline.command import output_of

SOURCES = ("pyproject.toml", "README.md", "LICENSE")
PACKAGE = "robo_genesis"
CACHED = "__pycache__"
EPOCH = "315532800"
"""1980-01-01, the oldest time that a zip can hold."""

BUILD = "import sys; from setuptools import build_meta; print(build_meta.build_wheel(sys.argv[1]))"


@cache
def build_wheel(folder: Path, root: Path = ROOT, repository: str = "") -> Path:
    """Write the wheel and return its path; the labs of one site share it.

    Args:
        folder: gets the wheel.
        root: the checkout.
        repository: an address for the metadata of the wheel, empty for none.

    Raises:
        ProjectError: setuptools failed; the message contains its output.
    """
    files = [root / source for source in SOURCES]
    files += sorted(p for p in (root / PACKAGE).rglob("*") if p.is_file() and CACHED not in p.parts)
    inputs = [part for p in files for part in (os.fsencode(p.relative_to(root)), p.read_bytes())]
    inputs.append(repository.encode())
    built = derived("wheel", inputs, lambda: built_wheel(root, repository))
    name, _, content = built.partition(b"\n")
    wheel = folder / name.decode()
    write_whole(wheel, content)
    return wheel


def built_wheel(root: Path, repository: str = "") -> bytes:
    """Return the name of the wheel, a line end and its content; `root` stays as it is."""
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name)
        for source in SOURCES:
            shutil.copy(root / source, copy)
        if repository:
            with (copy / SOURCES[0]).open("a", encoding="utf8") as project:
                project.write(f"\n[project.urls]\nRepository = {json.dumps(repository)}\n")
        shutil.copytree(root / PACKAGE, copy / PACKAGE, ignore=shutil.ignore_patterns(CACHED))
        for path in copy.rglob("*"):
            path.chmod(0o755 if path.is_dir() else 0o644)  # whatever the user's umask
        settings = os.environ | {"SOURCE_DATE_EPOCH": EPOCH}
        command, refusal = [sys.executable, "-c", BUILD, "."], "The package's wheel cannot be built"
        name = output_of(command, refusal, cwd=copy, env=settings).splitlines()[-1]
        return f"{name}\n".encode() + (copy / name).read_bytes()
