"""Three machines that are not ready: each is broken on purpose, in a process of its own."""

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robo_genesis.core.exercises import Mistake
from robo_genesis.lessons.l01 import machine
from robo_genesis.sim.fresh_process import run_python

MEASURES = False


def broken_step(name: str, report: Mapping[str, Any], step: str) -> Mistake:
    """Return a failure on purpose by the step at which the doctor stopped."""
    found = next(s for s in report["steps"] if s["step"] == step)["found"]
    return Mistake(
        name,
        shown=report["broken"] == step,
        evidence=f"The doctor stops at step {machine.STEPS.index(step) + 1}, `{step}`: {found}",
    )


def wrong_version() -> Mistake:
    """Run the doctor where the installed engine has another version than the pinned one."""
    with tempfile.TemporaryDirectory() as folder:
        metadata = Path(folder, "genesis_world-0.0.1.dist-info", "METADATA")
        metadata.parent.mkdir()
        metadata.write_text("Metadata-Version: 2.1\nName: genesis-world\nVersion: 0.0.1\n")
        first = os.pathsep.join([folder, os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
        return broken_step("wrong_version", machine.examine({"PYTHONPATH": first}), "version")


def no_egl() -> Mistake:
    """Run the doctor where the file of EGL contains a line of text."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "libEGL.so.1").write_text("not a library")
        return broken_step("no_egl", machine.examine({"LD_LIBRARY_PATH": folder}), "libraries")


def absent_backend() -> Mistake:
    """Ask the engine for a processor that this machine does not have."""
    call = 'import genesis as gs\ntry:\n    gs.init(backend=gs.metal, logging_level="error")\n'
    call += 'except Exception as error:\n    print(type(error).__name__, error, sep=": ")\n'
    call += "else:\n    print(gs.backend.name)"
    line = run_python(["-c", call], {}).strip().splitlines()[-1]
    return Mistake(
        "absent_backend",
        shown="Exception" in line or "Error" in line,
        evidence=f"`gs.init(backend=gs.metal)` on this machine, in a process of its own: `{line}`",
    )
