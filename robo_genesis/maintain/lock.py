"""requirements.lock: the exact version of every package that the course installs.

pip resolves the project with all extras as if nothing were installed; with `keep`,
every installed version stays that still fits, so a new pin changes only what it forces
to change. Versions are written without their local part (`2.13.0`, not `2.13.0+cpu`),
and the parts of Torch's CUDA build are left out: so the same lock installs with PyPI's
Torch and with a build for the CPU alone.
"""

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from robo_genesis.core.files import write_whole
from robo_genesis.core.project import COURSE, ENGINE, ROOT, ProjectError

LOCK = ROOT / "requirements.lock"
EXTRAS = ("book", "dev")
CUDA_PART = re.compile(r"nvidia-|cuda-|triton")
HEADER = """\
# Every package of the course with its exact version. Written by `make lock`; do not edit by hand.
# Resolved for CPython 3.11 on Linux x86-64. Torch's own CUDA packages are not named: its build
# is your choice, and each build names its own exactly.
"""


def write_lock(constraints: Sequence[str], keep: bool = False) -> str:
    """Resolve and write the lock in one step; return a line about it.

    Args:
        constraints: further requirements. Torch keeps its locked version unless one
            names another.
        keep: start from the installed packages.

    Raises:
        ProjectError: pip cannot resolve the project; the old lock is unchanged.
    """
    old = LOCK.read_text("utf8") if LOCK.exists() else ""
    if not any(canonicalize_name(one).startswith("torch=") for one in constraints):
        constraints = [*constraints, *re.findall("^torch==.*$", old, re.MULTILINE)]
    packages = resolve(constraints, keep)
    versions = {
        packages[n]["name"]: packages[n]["version"].split("+")[0]
        for n in needed(packages)
    }
    text = HEADER + "".join(
        f"{n}=={versions[n]}\n" for n in sorted(versions, key=str.lower)
    )
    if text != old:  # a new date alone would rebuild .venv
        write_whole(LOCK, text.encode())
    return f"{LOCK.name}: {len(versions)} packages, {ENGINE} {versions[ENGINE]}"


def resolve(constraints: Sequence[str], keep: bool = False) -> dict[str, Any]:
    """Return name → metadata of the packages that pip would install into an empty environment.

    Args:
        constraints: further requirements of this resolution.
        keep: start from the installed packages instead, and return all of them as well.
    """
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "pip", "install", "--dry-run"]
        command += [] if keep else ["--ignore-installed"]
        command += [
            "-qq",
            "--report",
            str(report),
            f"{ROOT}[{','.join(EXTRAS)}]",
            *constraints,
        ]
        if subprocess.run(command, check=False).returncode:
            raise ProjectError(
                "pip cannot resolve pyproject.toml; its reason is above."
            )
        found = [item["metadata"] for item in json.loads(report.read_text())["install"]]
    installed = [package.metadata.json for package in distributions()] if keep else []
    return {
        canonicalize_name(metadata["name"]): metadata
        for metadata in [*installed, *found]
    }


def needed(packages: Mapping[str, Any]) -> set[str]:
    """Return the names that the project needs, directly or not, without Torch's CUDA parts."""
    found: set[tuple[str, str]] = set()
    waiting = [(COURSE, extra) for extra in ("", *EXTRAS)]
    while waiting:
        name, extra = waiting.pop()
        if (name, extra) in found or name not in packages:
            continue
        found.add((name, extra))
        for requirement in map(Requirement, packages[name].get("requires_dist", [])):
            below = canonicalize_name(requirement.name)
            part_of_build = name == "torch" and CUDA_PART.match(below)
            applies = not requirement.marker or requirement.marker.evaluate(
                {"extra": extra}
            )
            if applies and not part_of_build:
                waiting += [(below, extra) for extra in ("", *requirement.extras)]
    return {name for name, _ in found} - {COURSE}
