"""The data of the lesson's explorer, the map of starts."""

from typing import Any

import numpy as np

from robo_genesis.core import maps
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import decimal
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm import ladder, picking

from . import metrics, spec

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
    level, apart = metrics.reached(trace, case), ladder.off_axis(trace, case)[-1]
    cells = []
    for k, moving in enumerate((trace.phase == picking.MOVE).T):
        press = np.median(trace.force[moving, k]) if moving.any() else 0.0
        cells.append(cell(k, int(level[k]), press, 1000 * apart[k]))
    x, y = (np.linspace(*ends, 2 * spec.CELLS + 1)[1::2] for ends in spec.REGION)
    starts = maps.grid(
        "Starts from above [mm]: x to the right, y upwards. A cell is an episode.",
        [f"{1000 * place:.0f}" for place in x],
        [decimal(1000 * place, 0) for place in y],
        cells,
        run="ends",
        label="Starts",
    )
    return {
        "around": True,
        "maps": [starts],
        "measures": [{"label": "rungs passed"}, {"label": "error along the pads [mm]"}],
        "columns": COLUMNS,
        "notes": {},
        "dt": case.dt,
        "postures": {"ends": np.insert(case.beliefs, 2, case.size[2] / 2, axis=1)},
        "traces": {"ends": ends(found)},
    }


def cell(number: int, level: int, press: float, apart: float) -> dict[str, Any]:
    """Return a cell of the map, which shows the end of its episode."""
    x, y = 1000 * spec.STARTS[number]
    error = 1000 * (spec.ASKEW.beliefs - spec.STARTS)[number]
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
            decimal(apart, 0),
        ],
        "numbers": [level, round(float(error[0]), 1)],
        "texts": [str(level), decimal(error[0], 0)],
    }


def ends(found: Experiment) -> BodyTrace:
    """Return the start and all ends: links by forward kinematics, the object as recorded."""
    from robo_genesis.sim.mujoco.kinematics import link_poses

    trace = found.traces["askew"]
    q, pos, quat = (
        np.concatenate([of[:1, 0], of[-1]])
        for of in (trace.q, trace.object_pos, trace.object_quat)
    )
    at, turn = link_poses(q, found.links[:-1])
    places = np.concatenate([at, pos[:, None]], axis=1)
    turns = np.concatenate([turn, quat[:, None]], axis=1)
    still = np.zeros_like(places)
    return BodyTrace(np.arange(len(q)) * spec.ASKEW.dt, places, turns, still, still)
