"""The machine of a run: the doctor's steps, and what a start costs.

Each function starts a process of its own, because an engine starts once in a process.
"""

import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.experiment import Readings, counts
from robo_genesis.sim import diagnosis
from robo_genesis.sim.fresh_process import last_value, run_python

from . import spec

# The doctor's steps in their order.
STEPS = tuple(step.__name__ for step in diagnosis.STEPS)

# Groups of a bundle's metrics: 1 for each step that passed, and elapsed times.
DOCTOR, TIMES = "doctor", "times"

# Parts of a start, and their words in a figure.
PARTS = {
    "import": "import",
    "init": "gs.init",
    "scene": "scene, entities",
    "build": "scene.build",
    "first_step": "first step",
}

# A process that finds no compiled kernels, and one that finds those of the first.
STARTS = ("first", "second")

TIMED = [f"{start}_{part}" for start in STARTS for part in PARTS]
READINGS = {
    DOCTOR: counts(STEPS),
    TIMES: Readings(dict.fromkeys(TIMED, "s"), "performance"),
}

SCRIPT = f"""\
import json, time
marks = [time.perf_counter()]
mark = lambda: marks.append(time.perf_counter())
import genesis as gs
mark()
gs.init(
    backend=gs.cpu, seed=0, use_deterministic_algorithms=True, logging_level="error"
)
mark()
scene = gs.Scene(
    sim_options=gs.options.SimOptions(dt=0.01, substeps=2),
    profiling_options=gs.options.ProfilingOptions(show_FPS=False),
    show_viewer=False,
)
scene.add_entity(gs.morphs.Plane())
scene.add_entity(gs.morphs.Sphere(radius={spec.RADIUS}, pos=(0, 0, 0.5)))
mark()
scene.build()
mark()
scene.step()
mark()
print(json.dumps([b - a for a, b in zip(marks, marks[1:])]))
"""


def examine(changed: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Run the doctor in a process of its own and return its report.

    Args:
        changed: environment variables beside those of this process.

    Raises:
        StartError: it printed no report.
    """
    command = ["-m", "robo_genesis.doctor", "--json"]
    return json.loads(run_python(command, changed or {}, statuses=(0, 1)))


def passed(report: Mapping[str, Any]) -> dict[str, int]:
    """Return 1 for each step of a report that passed, else 0."""
    states = {step["step"]: step["state"] for step in report["steps"]}
    return {step: int(states.get(step) == "ok") for step in STEPS}


def measure_starts() -> dict[str, float]:
    """Start the engine twice on the CPU, first with empty folders of code; return times [s].

    In a build that has compiled nothing yet, these are the folders of all pages.

    Raises:
        StartError: a process failed.
    """
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        changed = {}
        # A build that was killed has saved what Numba compiled, but no kernels.
        numba = Path(project.cache_folders()[project.NUMBA])
        if not project.nothing_compiled(os.environ) or any(numba.rglob("*.nbi")):
            changed = project.engine_cache_environment(cache=Path(folder))
        for start in STARTS:
            times = last_value(run_python(["-c", SCRIPT], changed))
            found |= {
                f"{start}_{part}": t for part, t in zip(PARTS, times, strict=True)
            }
    return found
