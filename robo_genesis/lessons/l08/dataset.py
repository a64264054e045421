"""The episodes of the lab as a dataset: a row for each sample that a command follows."""

from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.franka import CREDIT
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.camera import film

from . import metrics, spec

TASK = "Pick up the cylinder and place it in the bowl."

PLACE = tuple(f"object_{of}" for of in ("x", "y", "z", "qw", "qx", "qy", "qz"))

# By name the values, and the names of their last axis.
Columns = dict[str, tuple[np.ndarray, tuple[str, ...] | None]]

# Columns that a robot outside a simulator does not have.
PRIVILEGED = ("observation.environment_state", "finger_force", "phase")


def columns(run: Experiment) -> Columns:
    """Return by name the values (episodes, rows, …), and the names of their last axis.

    Row k has sample k, and the last command before sample k + 1.
    """
    trace, case, joints = run.traces["exact"], run.cases["exact"], run.joints.names
    good = metrics.reached(trace, case) == len(metrics.RUNGS)
    last = (np.arange(trace.steps) == trace.steps - 1)[:, None]
    pose = np.concatenate([trace.object_pos, trace.object_quat], axis=2)
    by_time: Columns = {
        "observation.state": (trace.q[:-1], joints),
        "observation.environment_state": (pose[:-1], PLACE),
        "action": (trace.target, joints),
        "finger_force": (trace.force[:-1], ("left", "right")),
        "phase": (trace.phase[1:].astype(np.int64), None),
        "next.success": (last & good, None),
        "next.done": (last & np.ones_like(good), None),
    }
    return {
        name: (values.swapaxes(0, 1), names)
        for name, (values, names) in by_time.items()
    }


def recorded(run: Experiment) -> dict[str, Any]:
    """Return the data as `site/takeaways/lerobot.py` writes them."""
    trace, count = run.traces["exact"], len(spec.FILMS) * run.rendered
    shown = [
        film.pictures_of(run.frames, name, trace.steps) for name in spec.FILMS[:count]
    ]
    return {
        "task": TASK,
        "robot": "franka_panda",
        "fps": round(1 / trace.dt),
        "columns": columns(run),
        "privileged": PRIVILEGED,
        "pictures": np.stack(shown) if shown else None,
        "parameters": run.page.parameters(),
        "credit": CREDIT,
    }


def finger_motion(run: Experiment) -> tuple[FloatArray, FloatArray]:
    """Return by episode (e,) the largest distance of a finger from its start until the
    row whose action closes the fingers, and the least motion of a finger from there to
    the next row [m].
    """
    found, used = columns(run), ("observation.state", "action")
    q, action = (found[name][0][..., ARM:].astype(np.float64) for name in used)
    closing = (action == 0).all(axis=2).argmax(axis=1)
    until = np.arange(q.shape[1]) <= closing[:, None]
    before = np.where(until[..., None], np.abs(q - q[:, :1]), 0).max(axis=(1, 2))
    rows = np.arange(len(q))
    return before, np.abs(q[rows, closing + 1] - q[rows, closing]).min(axis=1)
