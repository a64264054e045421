"""The maps of postures: the places of recorded answers in a map. What a recorded picture shows."""

from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l05 import spec, study
from robo_genesis.lessons.l05.text import QUANTITIES, records
from robo_genesis.sim.camera.geometry import other_axes
from robo_genesis.sim.camera.record import DEPTH_UNIT, SEGMENTS, view_of

MEASURES = False

COLUMNS = 9
"""Most cells in a row of a map."""

PLACES = {
    "vertical": ("Plane y = 0. x [m] to the right, z [m] upwards.", ("z", "x"), spec.GRID_Z),
    "horizontal": (
        f"Plane z = {spec.HEIGHT:g} m. x [m] to the right, y [m] upwards.", ("y", "x"), spec.GRID_Y,
    ),
}  # fmt: skip
"""Caption, axes and values from the bottom of the maps of targets."""

PICTURES = {
    spec.VIEWED: {
        "alt": "Camera frame of the robot at its start. An orange ball is below its hand.",
        "caption": "Each pixel with a surface gives a 3D point. Depth and point belong to the "
        "pixel's centre.",
    },
    "cut": {
        "alt": "Camera frame of the robot. The floor exists only in a band. The hand and the wrist "
        "are cut open.",
        "caption": "Surfaces nearer than the near limit or farther than the far one are missing: "
        "the hand is cut open, and the floor is a band.",
    },
}
"""Alternative text and caption of the pictures that a reader can read."""


def posture_maps(run: Experiment, which: str) -> list[dict[str, Any]]:
    """Return the maps called `reach`, or `solutions`.

    Returns:
        By map the `run` with its postures, `targets` (m, 3) [m], a `caption`, the names of both
        `axes`, `rows` from the top with the numbers of their answers, the labels of `columns`, the
        columns of `records` that cells can show as `measures`, and `records`, one for each answer.
    """
    maps = [solution_map(run)] if which == "solutions" else [plane_map(name) for name in PLACES]
    for one in maps:
        shown = {str(key) for row in one["rows"] for key in row["cells"]}
        one["targets"] = spec.QUESTIONS[one["run"]].positions
        one["columns"] = [f"{value:g}" for value in one["columns"]]
        one["measures"] = tuple(QUANTITIES)
        one["records"] = [row for row in records(run, one["run"]) if row["answer"] in shown]
    return maps


def plane_map(name: str) -> dict[str, Any]:
    """Return run, caption, axes, rows and columns of a map of targets."""
    (caption, axes, upwards), columns = PLACES[name], spec.GRID_X
    numbers = np.arange(1, len(columns) * len(upwards) + 1).reshape(-1, len(columns)).tolist()
    rows = [{"label": f"{v:g}", "cells": of} for v, of in zip(upwards, numbers, strict=True)]
    return {"run": name, "caption": caption, "axes": axes, "rows": rows[::-1], "columns": columns}


def solution_map(run: Experiment) -> dict[str, Any]:
    """Return the same of the map of answers for one target."""
    rows = [
        {"label": str(number), "cells": [k + 1 for k in inside[at : at + COLUMNS]]}
        for number, (_, inside) in enumerate(study.solution_families(run), start=1)
        for at in range(0, len(inside), COLUMNS)
    ]
    return {
        "run": "many_starts",
        "caption": "One target has many answers. Each row belongs to one curve; joint1 grows from "
        "left to right.",
        "axes": ("curve", "place"),
        "rows": rows,
        "columns": range(1, COLUMNS + 1),
    }


def picture(run: Experiment, name: str) -> dict[str, Any]:
    """Return what reads a recorded view: JSON values for `site/picture_reader.py`.

    Returns:
        `size`, `K`, `pose` (OpenCV axes), the `unit` of a depth [m], by number the `names`, heights
        of `planes` [m], centre and radius of `spheres` [m], and `alt` and `caption`.
    """
    view, numbers = view_of(run, name), run.readings[SEGMENTS]
    links = dict(enumerate(run.links, int(numbers["hand"]) - run.links.index("hand")))
    return {
        "size": view.size,
        "K": view.intrinsics.tolist(),
        "pose": other_axes(view.transform)[:3].tolist(),
        "unit": DEPTH_UNIT,
        "names": {0: "nothing"} | links | {numbers[name]: name for name in spec.SEGMENTS},
        "planes": {numbers["plane"]: 0.0},
        "spheres": {numbers["marker"]: [*spec.TARGET.tolist(), spec.MARKER_RADIUS]},
        **PICTURES[name],
    }
