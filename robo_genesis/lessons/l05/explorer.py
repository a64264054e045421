"""The maps of postures: the places of recorded answers in a map. What a recorded picture shows."""

from collections.abc import Sequence
from typing import Any

from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05 import camera_spec, spec, study
from robo_genesis.lessons.l05.solutions_text import MEASURES, records
from robo_genesis.lessons.view_record import DEPTH_UNIT, SEGMENTS, view_of
from robo_genesis.sim.camera_geometry import other_axes

COLUMNS = 9
"""Most cells in a row of a map."""

PLACES = {
    "vertical": ("Plane y = 0. x [m] to the right, z [m] upwards.", ("z", "x"), spec.GRID_Z),
    "horizontal": (
        f"Plane z = {spec.HEIGHT:g} m. x [m] to the right, y [m] upwards.", ("y", "x"), spec.GRID_Y,
    ),
}  # fmt: skip
"""Caption, axes and values from the bottom of the maps of targets."""


def posture_maps(run: Experiment, which: str) -> list[dict[str, Any]]:
    """Return the maps called `reach`, or `solutions`.

    Returns:
        By map the `run` with its postures, `targets` (m, 3) [m], a `caption`, the names of both
        `axes`, `rows` from the top with the numbers of their answers, the labels of `columns`, the
        columns of `records` that cells can show as `measures`, and `records`, one for each answer.
    """
    names = ("many_starts",) if which == "solutions" else tuple(PLACES)
    return [
        {
            "run": name,
            "targets": spec.QUESTIONS[name].positions,
            "caption": caption,
            "axes": axes,
            "rows": rows,
            "columns": [f"{value:g}" for value in columns],
            "measures": tuple(MEASURES),
            "records": [row for row in records(run, name) if row["answer"] in shown],
        }
        for name in names
        for caption, axes, rows, columns in [_places(run, name)]
        for shown in [{str(key) for row in rows for key in row["cells"]}]
    ]


def _places(run: Experiment, name: str) -> tuple[str, tuple[str, str], list[Any], Sequence[float]]:
    """Return caption, axes, rows and columns of a map."""
    if name in PLACES:
        caption, axes, upwards = PLACES[name]
        width = len(spec.GRID_X)
        rows = [
            {"label": f"{value:g}", "cells": [*range(k * width + 1, (k + 1) * width + 1)]}
            for k, value in enumerate(upwards)
        ]
        return caption, axes, rows[::-1], spec.GRID_X
    rows = [
        {"label": str(number), "cells": [k + 1 for k in inside[at : at + COLUMNS]]}
        for number, (_, inside) in enumerate(study.solution_families(run), start=1)
        for at in range(0, len(inside), COLUMNS)
    ]
    caption = "Answers for one target. Rows: their curve, and on it joint1 from low to high."
    return caption, ("curve", "place"), rows, range(1, COLUMNS + 1)


def picture(run: Experiment, name: str) -> dict[str, Any]:
    """Return what reads a recorded view: JSON values for `site/picture_reader.py`.

    Returns:
        `size`, `K`, `pose` (OpenCV axes), the `unit` of a depth [m], by number the `names`, heights
        of `planes` [m], centre and radius of `spheres` [m], and `alt` and `caption`.
    """
    view, numbers = view_of(run, name), run.readings[SEGMENTS]
    first = numbers["hand"] - run.links.index("hand")
    links = {first + k: link for k, link in enumerate(run.links)}
    return {
        "size": view.size,
        "K": view.intrinsics.tolist(),
        "pose": other_axes(view.transform)[:3].tolist(),
        "unit": DEPTH_UNIT,
        "names": {0: "nothing"} | links | {numbers[name]: name for name in spec.SEGMENTS},
        "planes": {numbers["plane"]: 0.0},
        "spheres": {numbers["marker"]: [*spec.TARGET.tolist(), spec.MARKER_RADIUS]},
        **camera_spec.PICTURES[name],
    }
