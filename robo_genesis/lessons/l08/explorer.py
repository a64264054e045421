"""The data of the lesson's explorer, the map of starts."""

from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import decimal
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l08 import metrics, spec
from robo_genesis.sim.arm import picking

MEASURES = False

COLUMNS = (
    "start x, y [mm]",
    "error x, y [mm]",
    "rungs passed",
    "first failed",
    "force of each finger in the move [N]",
    "from the bowl's axis [mm]",
)


def explored(found: Experiment) -> dict[str, Any]:
    """Return the data of the map, as `site/figures/explorer.py` shows them."""
    trace, case = found.traces["askew"], spec.ASKEW
    level, apart = metrics.reached(trace, case), metrics.off_axis(trace, case)[-1]
    moving = trace.phase == picking.MOVE
    press = np.array(
        [
            np.median(trace.force[moving[:, k], k]) if moving[:, k].any() else 0.0
            for k in range(len(level))
        ]
    )
    cells = [cell(k, int(level[k]), press[k], apart[k]) for k in range(len(level))]
    n = spec.CELLS
    y = np.linspace(*spec.REGION[1], n + 1)
    rows = [
        {"label": decimal(1000 * (y[k] + y[k + 1]) / 2, 0), "cells": cells[k * n :][:n]}
        for k in range(n)
    ]
    x = 100 * np.linspace(*spec.REGION[0], 2 * n + 1)[1::2]
    caption = (
        "Starts from above, x [cm] to the right, y [mm] upwards. A cell is an episode."
    )
    return {
        "thing": "robot",
        "around": True,
        "choices": ("Map", "Cells show"),
        "maps": [
            {
                "run": "ends",
                "label": "Starts",
                "caption": caption,
                "rows": rows[::-1],
                "columns": [str(round(value)) for value in x],
            }
        ],
        "measures": [{"label": "rungs passed"}, {"label": "error along the pads [mm]"}],
        "columns": COLUMNS,
        "notes": {},
        "dt": case.dt,
        "postures": {"ends": np.insert(case.beliefs, 2, case.size[2] / 2, axis=1)},
        "traces": {"ends": ends(found)},
    }


def cell(number: int, level: int, press: float, apart: float) -> dict[str, Any]:
    """Return a cell of the map, which shows the end of its episode."""
    (x, y), error = (
        1000 * spec.STARTS[number],
        1000 * (spec.ASKEW.beliefs - spec.STARTS)[number],
    )
    done = level == len(metrics.RUNGS)
    failed = "none" if done else metrics.RUNGS[level]
    place = f"{x:.0f}, {decimal(y, 0)}"
    return {
        "answer": number + 1,
        "name": place,
        "tag": "",
        "state": "accepted" if done else "refused",
        "opens": number == spec.SHOWN["placed"],
        "sentence": "In the bowl, at rest." if done else f"Fails at “{failed}”.",
        "values": [
            place,
            f"{decimal(error[0], 1)}, {decimal(error[1], 1)}",
            str(level),
            failed,
            decimal(press, 1),
            decimal(1000 * apart, 0),
        ],
        "numbers": [level, round(float(error[0]), 1)],
        "texts": [str(level), decimal(error[0], 0)],
    }


def ends(found: Experiment) -> Trace:
    """Return the start and all ends: links by forward kinematics, the object as recorded."""
    from robo_genesis.sim.mujoco.kinematics import link_poses

    trace = found.traces["askew"]
    q, pos, quat = (
        np.concatenate([of[:1, 0], of[-1]])
        for of in (trace.q, trace.object_pos, trace.object_quat)
    )
    at, turn = link_poses(q, found.links[:-1])
    none = np.zeros_like(q[1:])
    return Trace(
        t=np.arange(len(q)) * spec.ASKEW.dt,
        q=q,
        qd=none,
        target=none,
        control_force=none,
        internal_force=none,
        start_control_force=none[0],
        start_qd=none[0],
        effort_limit=none[0],
        link_pos=np.concatenate([at, pos[:, None]], axis=1),
        link_quat=np.concatenate([turn, quat[:, None]], axis=1),
    )
