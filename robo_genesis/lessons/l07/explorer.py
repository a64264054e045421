"""The data of the lesson's explorer, the map of the table."""

from typing import Any

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l07 import rungs, table_map

MEASURES = False


def explored(found: Experiment) -> dict[str, Any]:
    """Return the data of the map, as `site/figures/explorer.py` shows them."""
    cells = [_cell(found, number) for number in table_map.CELLS]
    wide = len(table_map.X)
    rows = [
        {"label": f"{y:.2f}".replace("-", "−"), "cells": cells[k * wide : (k + 1) * wide]}
        for k, y in enumerate(table_map.Y)
    ]
    caption = "Table from above. x [m] to the right, y [m] upwards. An outline cut off counts 0."
    columns = ["place x, y [m]", *table_map.WORDS.values()]
    cameras = "beside the table", "on the hand"
    return {
        "thing": "robot",
        "choices": ("Map", "Cells show"),
        "maps": [{"run": "table", "label": "Table", "caption": caption, "rows": rows[::-1],
                  "columns": [f"{x:g}" for x in table_map.X]}],
        "measures": [{"label": f"pixels, camera {place}"} for place in cameras],
        "columns": columns,
        "notes": {"×": "×: out of reach.", "○": "○: the bowl or the edge is in the way."},
        "dt": table_map.CASE.dt,
        "postures": {"table": table_map.CASE.targets},
        "tables": {caption: [dict(zip(columns, of["values"], strict=True)) for of in cells]},
    }  # fmt: skip


def _cell(found: Experiment, cell: int) -> dict[str, Any]:
    """Return a cell of the map, which shows the answer for the grasp."""
    good, (x, y) = table_map.verdicts(found, cell), table_map.CASE.places[cell]
    numbers = [round(table_map.outline(found, name, cell)) for name in rungs.CAMERAS]
    failed = ", ".join(table_map.WORDS[name] for name, one in good.items() if not one)
    place = f"{x:g}, {y:.2f}".replace("-", "−")
    return {
        "answer": 2 * cell + 2,
        "name": place,
        "tag": "×" if not good["reachable"] else "" if good["graspable"] else "○",
        "state": "accepted" if good["reachable"] else "refused",
        "opens": cell == len(table_map.CELLS) // 2,
        "sentence": f"Not passed: {failed}." if failed else "Passes all four tests.",
        "values": [place, *("yes" if one else "no" for one in good.values())],
        "numbers": numbers,
        "texts": [str(number) for number in numbers],
    }
