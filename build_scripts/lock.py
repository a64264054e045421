"""Write requirements.lock: the exact version of every package that the course installs.

pip resolves the project with all extras as if nothing were installed. Versions are written without
their local part (`2.13.0`, not `2.13.0+cpu`), and what Torch's CUDA build brings along is left out:
so the same lock installs with PyPI's Torch and with a build of Torch for the processor alone.

Usage: python build_scripts/lock.py [NAME==VERSION ...]   (constraints for this resolution)
Torch keeps the version it is locked at, unless a constraint names another.
"""

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "requirements.lock"
PROJECT = "robo-genesis"
CUDA_PART = re.compile(r"nvidia-|cuda-|triton")
HEADER = """\
# Every package of the course with its exact version. Written by `make lock`; do not edit by hand.
# Resolved for CPython 3.11 on Linux x86-64. Torch's own CUDA packages are not named: its build
# is your choice, and each build names its own exactly.
"""


def resolve(constraints: list[str]) -> dict[str, Mapping[str, Any]]:
    """Return name → metadata of all that pip would install into an empty environment."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "pip", "install", "--dry-run", "--ignore-installed"]
        command += ["-qq", "--report", str(report), f"{ROOT}[book,dev]", *constraints]
        subprocess.run(command, check=True)
        items = json.loads(report.read_text())["install"]
    return {canonical(item["metadata"]["name"]): item["metadata"] for item in items}


def canonical(name: str) -> str:
    """Return a package's name as indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(packages: Mapping[str, Mapping[str, Any]]) -> set[str]:
    """Return what the project needs, directly or not, the parts of Torch's CUDA build aside."""
    found, waiting = set(), [PROJECT]
    while waiting:
        name = waiting.pop()
        if name in found or name not in packages:
            continue
        found.add(name)
        lines = packages[name].get("requires_dist", [])
        below = {canonical(re.split(r"[^\w.-]", line, maxsplit=1)[0]) for line in lines}
        waiting += [n for n in below if name != "torch" or not CUDA_PART.match(n)]
    return found - {PROJECT}


def locked_torch() -> list[str]:
    """Return the constraint that keeps Torch where it is, none where there is no lock yet."""
    lines = LOCK.read_text().splitlines() if LOCK.exists() else []
    return [line for line in lines if line.startswith("torch==")]


def main() -> int:
    """Resolve and write the lock in one step; a failed resolution leaves the old one."""
    constraints = sys.argv[1:]
    if not any(canonical(c).startswith("torch=") for c in constraints):
        constraints += locked_torch()
    packages = resolve(constraints)
    versions = {packages[n]["name"]: packages[n]["version"].split("+")[0] for n in needed(packages)}
    lines = [f"{name}=={versions[name]}\n" for name in sorted(versions, key=str.lower)]
    text = HEADER + "".join(lines)
    if not LOCK.exists() or LOCK.read_text() != text:  # a new date alone would rebuild .venv
        LOCK.write_text(text)
    print(f"{LOCK.name}: {len(lines)} packages, genesis-world {versions['genesis-world']}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
