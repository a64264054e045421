"""The episodes of the lab as a dataset: a row for each sample that a command follows."""

from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l08 import metrics, spec
from robo_genesis.sim.camera import film

MEASURES = False

PLACE = tuple(f"object_{of}" for of in ("x", "y", "z", "qw", "qx", "qy", "qz"))
FORCES = ("left_finger", "right_finger")

TASK = "Pick up the cylinder and place it in the bowl."


def recorded(run: Experiment) -> dict[str, Any]:
    """Return the data as `site/takeaways/lerobot.py` writes them."""
    trace, case = run.traces["exact"], run.cases["exact"]
    rows, episodes = trace.target.shape[:2]
    good = metrics.reached(trace, case) == len(metrics.RUNGS)
    last = np.arange(rows) == rows - 1
    pose = np.concatenate([trace.object_pos, trace.object_quat], axis=2)
    by_time = {
        "observation.state": (trace.q[:-1], run.joints.names),
        "observation.environment_state": (pose[:-1], PLACE),
        "observation.force": (trace.force[:-1], FORCES),
        "action": (trace.target, run.joints.names),
        "phase": (trace.phase[1:].astype(np.int64), None),
        "next.success": (last[:, None] & good, None),
        "next.done": (last[:, None] & np.ones(episodes, bool), None),
    }
    names = spec.FILMS if run.rendered else ()
    shown = [film.pictures_of(run.frames, name, rows + 1)[:-1] for name in names]
    return {
        "task": TASK,
        "robot": "franka_panda",
        "fps": round(1 / trace.dt),
        "columns": {name: (v.swapaxes(0, 1), of) for name, (v, of) in by_time.items()},
        "pictures": np.stack(shown) if shown else None,
    }
