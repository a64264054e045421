"""The data of the lesson's explorer, the map of the table."""

from typing import Any

import numpy as np

from robo_genesis.core import maps
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import decimal

from . import rungs
from .table_map import CASE, CELLS, WORDS, X, Y, outlines, verdicts

MEASURES = False

# The words for a cell that does not pass a test of `table_map.WORDS`.
FAILED = {
    "reachable": "the hand does not reach it",
    **{
        name: f"the camera {place} does not show the whole outline"
        for name, place in rungs.CAMERAS.items()
    },
    "graspable": "the bowl or the edge is in the way",
}


def explored(found: Experiment) -> dict[str, Any]:
    """Return the data of the map, as `site/figures/explorer.py` shows them."""
    good = verdicts(found)
    areas = np.transpose([outlines(found, name) for name in rungs.CAMERAS])
    cells = [
        cell(k, {name: of[k] for name, of in good.items()}, areas[k]) for k in CELLS
    ]
    caption = "Table from above. x [m] to the right, y [m] upwards. An outline cut off counts 0."
    columns, rows = [f"{x:g}" for x in X], [decimal(y, 2) for y in Y]
    names = ["place x, y [m]", *WORDS.values()]
    return {
        "around": True,
        "maps": [maps.grid(caption, columns, rows, cells, run="table", label="Table")],
        "measures": [
            {"label": "tests passed"},
            *(
                {"label": f"thousand pixels, camera {place}"}
                for place in rungs.CAMERAS.values()
            ),
        ],
        "columns": names,
        "notes": {
            "×": "×: refused from one start.",
            "○": "○: the bowl or the edge is in the way.",
        },
        "dt": CASE.dt,
        "postures": {"table": CASE.targets},
        "tables": {
            caption: [dict(zip(names, of["values"], strict=True)) for of in cells]
        },
    }


def cell(number: int, good: dict[str, bool], pixels: FloatArray) -> dict[str, Any]:
    """Return a cell of the map, which shows the answer for the grasp."""
    reachable, graspable = good["reachable"], good["graspable"]
    words = {
        "reachable": "yes" if reachable else "no",
        **{
            name: f"{area:.0f} pixels"
            for name, area in zip(rungs.CAMERAS, pixels, strict=True)
        },
        "graspable": ("yes" if graspable else "no") if reachable else "not tested",
    }
    x, y = CASE.places[number]
    failed = [
        FAILED[name]
        for name, passed in good.items()
        if not passed and words[name] != "not tested"
    ]
    passes = int(sum(good.values()))
    return {
        "answer": 2 * number + 2,
        "name": (place := f"{x:g}, {decimal(y, 2)}"),
        "tag": "×" if not reachable else "" if graspable else "○",
        "state": "accepted" if reachable else "refused",
        "opens": number == len(CELLS) // 2,
        "sentence": f"{'; '.join(failed).capitalize()}."
        if failed
        else "Passes all four tests.",
        "values": [place, *words.values()],
        "numbers": [passes, *(round(area) for area in pixels)],
        "texts": [f"{passes}", *(f"{area / 1000:.1f}" for area in pixels)],
    }
