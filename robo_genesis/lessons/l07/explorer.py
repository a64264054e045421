"""The data of the lesson's explorer, the map of the table."""

from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import decimal
from robo_genesis.lessons.l07 import rungs
from robo_genesis.lessons.l07.table_map import (
    CASE,
    CELLS,
    WORDS,
    X,
    Y,
    outlines,
    verdicts,
)

MEASURES = False


def explored(found: Experiment) -> dict[str, Any]:
    """Return the data of the map, as `site/figures/explorer.py` shows them."""
    good = verdicts(found)
    areas = np.transpose([outlines(found, name) for name in rungs.CAMERAS])
    cells = [
        cell(k, {name: of[k] for name, of in good.items()}, areas[k]) for k in CELLS
    ]
    rows = [
        {"label": decimal(y, 2), "cells": cells[k * len(X) :][: len(X)]}
        for k, y in enumerate(Y)
    ]
    caption = "Table from above. x [m] to the right, y [m] upwards. An outline cut off counts 0."
    places = "beside the table", "on the hand"
    columns = ["place x, y [m]", *WORDS.values()]
    return {
        "thing": "robot",
        "around": True,
        "choices": ("Map", "Cells show"),
        "maps": [
            {
                "run": "table",
                "label": "Table",
                "caption": caption,
                "rows": rows[::-1],
                "columns": [f"{x:g}" for x in X],
            }
        ],
        "measures": [{"label": f"thousand pixels, camera {at}"} for at in places],
        "columns": columns,
        "notes": {
            "×": "×: refused from one start.",
            "○": "○: the bowl or the edge is in the way.",
        },
        "dt": CASE.dt,
        "postures": {"table": CASE.targets},
        "tables": {
            caption: [dict(zip(columns, of["values"], strict=True)) for of in cells]
        },
    }


def cell(number: int, good: dict[str, bool], pixels: FloatArray) -> dict[str, Any]:
    """Return a cell of the map, which shows the answer for the grasp."""
    (x, y), said = (
        CASE.places[number],
        {name: "yes" if one else "no" for name, one in good.items()},
    )
    for name, area in zip(rungs.CAMERAS, pixels, strict=True):
        said[name] = f"{area:.0f} pixels"
    if not good["reachable"]:
        said["graspable"] = "not tested"
    place = f"{x:g}, {decimal(y, 2)}"
    failed = [
        WORDS[name]
        for name, one in good.items()
        if not one and said[name] != "not tested"
    ]
    return {
        "answer": 2 * number + 2,
        "name": place,
        "tag": "×" if not good["reachable"] else "" if good["graspable"] else "○",
        "state": "accepted" if good["reachable"] else "refused",
        "opens": number == len(CELLS) // 2,
        "sentence": f"Not passed: {', '.join(failed)}."
        if failed
        else "Passes all four tests.",
        "values": [place, *said.values()],
        "numbers": [round(area) for area in pixels],
        "texts": [f"{area / 1000:.1f}" for area in pixels],
    }
