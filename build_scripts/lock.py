"""Write requirements.lock: the exact version of every package that the course installs.

pip resolves the project with all extras as if nothing were installed; with --keep, every installed
version stays that still fits, so a new pin moves only what it forces to move. Versions are written
without their local part (`2.13.0`, not `2.13.0+cpu`), and what Torch's CUDA build brings along is
left out: so the same lock installs with PyPI's Torch and with a build for the processor alone.

Usage: python build_scripts/lock.py [--keep] [NAME==VERSION ...]   (constraints)
Torch keeps the version it is locked at, unless a constraint names another.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "requirements.lock"
PROJECT = "robo-genesis"
EXTRAS = ("book", "dev")
CUDA_PART = re.compile(r"nvidia-|cuda-|triton")
HEADER = """\
# Every package of the course with its exact version. Written by `make lock`; do not edit by hand.
# Resolved for CPython 3.11 on Linux x86-64. Torch's own CUDA packages are not named: its build
# is your choice, and each build names its own exactly.
"""


def resolve(constraints: list[str], keep: bool = False) -> dict[str, Mapping[str, Any]]:
    """Return name → metadata of what pip would install into an empty environment.

    Args:
        constraints: further requirements of this resolution.
        keep: start from what is installed instead; what the project does not need is among it.
    """
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "pip", "install", "--dry-run"]
        command += [] if keep else ["--ignore-installed"]
        command += ["-qq", "--report", str(report), f"{ROOT}[{','.join(EXTRAS)}]", *constraints]
        if subprocess.run(command, check=False).returncode:
            sys.exit("pip cannot resolve pyproject.toml; its reason stands above.")
        found = [item["metadata"] for item in json.loads(report.read_text())["install"]]
    installed = [package.metadata.json for package in distributions()] if keep else []
    return {canonical(metadata["name"]): metadata for metadata in [*installed, *found]}


def canonical(name: str) -> str:
    """Return a package's name as indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(packages: Mapping[str, Mapping[str, Any]]) -> set[str]:
    """Return what the project needs, directly or not, the parts of Torch's CUDA build aside."""
    found: set[tuple[str, str]] = set()
    waiting = [(PROJECT, extra) for extra in ("", *EXTRAS)]
    while waiting:
        name, extra = waiting.pop()
        if (name, extra) in found or name not in packages:
            continue
        found.add((name, extra))
        for requirement in map(Requirement, packages[name].get("requires_dist", [])):
            below = canonical(requirement.name)
            part_of_build = name == "torch" and CUDA_PART.match(below)
            applies = not requirement.marker or requirement.marker.evaluate({"extra": extra})
            if applies and not part_of_build:
                waiting += [(below, asked) for asked in ("", *requirement.extras)]
    return {name for name, _ in found} - {PROJECT}


def locked_torch() -> list[str]:
    """Return the constraint that keeps Torch where it is, none where there is no lock yet."""
    lines = LOCK.read_text().splitlines() if LOCK.exists() else []
    return [line for line in lines if line.startswith("torch==")]


def write(text: str) -> None:
    """Put the lock in place in one move; what fails before leaves the old one."""
    partial = LOCK.with_name(f".{LOCK.name}.partial")
    try:
        partial.write_text(text)
        if LOCK.exists():
            shutil.copymode(LOCK, partial)
        os.replace(partial, LOCK)
    finally:
        partial.unlink(missing_ok=True)


def main() -> int:
    """Resolve and write the lock in one step; a failed resolution leaves the old one."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", action="store_true", help="keep installed versions that fit")
    parser.add_argument("constraints", nargs="*", metavar="NAME==VERSION")
    args = parser.parse_args()
    constraints = args.constraints
    if not any(canonical(c).startswith("torch=") for c in constraints):
        constraints += locked_torch()
    packages = resolve(constraints, args.keep)
    versions = {packages[n]["name"]: packages[n]["version"].split("+")[0] for n in needed(packages)}
    lines = [f"{name}=={versions[name]}\n" for name in sorted(versions, key=str.lower)]
    text = HEADER + "".join(lines)
    if not LOCK.exists() or LOCK.read_text() != text:  # a new date alone would rebuild .venv
        write(text)
    print(f"{LOCK.name}: {len(lines)} packages, genesis-world {versions['genesis-world']}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
