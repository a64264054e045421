"""Three machines that are not ready: each is broken on purpose, in a process of its own."""

import os
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from robo_genesis.core.exercises import Mistake
from robo_genesis.lessons.l01 import machine
from robo_genesis.sim.fresh_process import run_python

MEASURES = False

PLAIN = """\
import genesis as gs
try:
    gs.init(backend=gs.%s, logging_level="error")
    gs.Scene(show_viewer=False).build()
    print(gs.backend.name)
except Exception as error:
    print(f"{type(error).__name__}:", *str(error).split())
"""


def broken_step(name: str, report: Mapping[str, Any], step: str) -> Mistake:
    """Return a failure on purpose by the step at which the doctor stopped."""
    found = next((s["found"] for s in report["steps"] if s["state"] == "broken"), "nothing broken")
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
    """Run the doctor and a plain script where EGL finds the file of no driver."""
    with tempfile.TemporaryDirectory() as folder:
        changed = {"__EGL_VENDOR_LIBRARY_DIRS": folder}
        found = broken_step("no_egl", machine.examine(changed), "libraries")
        line = plain_script("cpu", changed)
    evidence = f"{found.evidence}\n\nA script with `gs.init` and `scene.build()` ends with `{line}`"
    return replace(found, shown=found.shown and "EGL" in line, evidence=evidence)


def absent_backend() -> Mistake:
    """Ask the engine for a processor that this machine does not have."""
    line = plain_script("metal", {})
    return Mistake(
        "absent_backend",
        shown="Exception" in line or "Error" in line,
        evidence=f"`gs.init(backend=gs.metal)` on this machine, in a process of its own: `{line}`",
    )


def plain_script(backend: str, changed: Mapping[str, str]) -> str:
    """Return how `PLAIN` ends in a process of its own, with changed environment variables."""
    return run_python(["-c", PLAIN % backend], changed).strip().splitlines()[-1]
