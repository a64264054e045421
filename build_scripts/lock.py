"""Write requirements.lock: the exact version of every package that the course installs.

pip resolves the project with all extras as if nothing were installed. Versions are written without
their local part (`2.13.0`, not `2.13.0+cpu`), so that the same lock installs with PyPI's Torch and
with a build of Torch for the processor alone.

Usage: python build_scripts/lock.py [NAME==VERSION ...]   (constraints for this resolution)
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "requirements.lock"
HEADER = """\
# Every package of the course with its exact version. Written by `make lock`; do not edit by hand.
# Resolved for CPython 3.11 on Linux x86-64. Torch's own CUDA packages are not named: its build
# is your choice, and each build names its own exactly.
"""


def resolve(constraints: list[str]) -> dict[str, str]:
    """Return name → public version of all that the project with its extras needs."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [sys.executable, "-m", "pip", "install", "--dry-run", "--ignore-installed"]
        command += ["--quiet", "--report", str(report), f"{ROOT}[book,dev]", *constraints]
        subprocess.run(command, check=True)
        items = json.loads(report.read_text())["install"]
    packages = {item["metadata"]["name"]: item["metadata"] for item in items}
    leave_out = {"robo-genesis"} | accelerator_parts_of_torch(packages)
    return {
        name: metadata["version"].split("+")[0]
        for name, metadata in packages.items()
        if name not in leave_out
    }


def accelerator_parts_of_torch(packages: dict[str, dict]) -> set[str]:
    """Names that only Torch asks for and that belong to its CUDA build."""
    needed_by = {
        name: {re.match(r"[\w.-]+", line)[0] for line in metadata.get("requires_dist", [])}
        for name, metadata in packages.items()
    }
    others = set().union(*(needs for name, needs in needed_by.items() if name != "torch"))
    parts = {n for n in needed_by["torch"] if n.startswith(("nvidia-", "cuda-", "triton"))}
    return parts - others


def main() -> int:
    """Resolve and write the lock in one step; a failed resolution leaves the old one."""
    versions = resolve(sys.argv[1:])
    lines = [f"{name}=={versions[name]}\n" for name in sorted(versions, key=str.lower)]
    LOCK.write_text(HEADER + "".join(lines))
    print(f"{LOCK.name}: {len(lines)} packages, genesis-world {versions['genesis-world']}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
