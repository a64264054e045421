"""The data of the explorers: recorded answers as cells of a map, and what a picture shows."""

from typing import Any

from robo_genesis.core import maps
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT
from robo_genesis.sim.camera.geometry import other_axes
from robo_genesis.sim.camera.record import DEPTH_UNIT, SEGMENTS, view_of

from . import spec, study
from .text import QUANTITIES, TIP, records

MEASURES = False

COLUMNS = 9  # Most cells in a row of a map

# Label, axis upwards and values from the bottom of the maps of targets.
PLACES = {
    "vertical": ("Plane y = 0", "z", spec.GRID_Z),
    "horizontal": (f"Plane z = {spec.HEIGHT:g} m", "y", spec.GRID_Y),
}

# Alternative text and caption of the pictures that a reader can read.
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

# What is read at a pixel.
READ = (
    "pixel",
    "shows",
    "depth",
    "point in the world",
    "closed form",
    "depth − closed form",
)


def explored(run: Experiment, name: str) -> dict[str, Any]:
    """Return the data of an explorer: maps (`reach`, `solutions`) or one of `PICTURES`."""
    return picture(run, name) if name in PICTURES else posture_maps(run, name)


def posture_maps(run: Experiment, which: str) -> dict[str, Any]:
    """Return the maps called `reach`, or `solutions`, as `site/figures/explorer.py` shows them."""
    shown = (
        [solution_map(run)]
        if which == "solutions"
        else [plane_map(run, name) for name in PLACES]
    )
    tables = {}
    for one in shown:
        answers = {cell["answer"] for row in one["rows"] for cell in row["cells"]}
        found = [r for r in records(run, one["run"]) if int(r["answer"]) in answers]
        tables[one["caption"]] = found
    return {
        "maps": shown,
        "measures": [{"label": name} for name in QUANTITIES],
        "columns": [*found[0]][1:],
        "notes": {
            "×": "×: refused.",
            "↓": "↓: accepted by its residual, fingertips in the floor.",
        },
        "dt": DT,
        "postures": {one["run"]: spec.QUESTIONS[one["run"]].positions for one in shown},
        "tables": tables,
    }


def plane_map(run: Experiment, name: str) -> dict[str, Any]:
    """Return the map of the targets in a plane."""
    label, axis, upwards = PLACES[name]
    columns, rows = ([f"{at:g}" for at in ends] for ends in (spec.GRID_X, upwards))
    places = [f"{axis} {row}, x {column}" for row in rows for column in columns]
    cells = map(_cell, records(run, name), places)
    caption = f"{label}. x [m] to the right, {axis} [m] upwards."
    return maps.grid(caption, columns, rows, [*cells], run=name, label=label)


def solution_map(run: Experiment) -> dict[str, Any]:
    """Return the map of the answers for one target."""
    found = records(run, "many_starts")
    rows = []
    for curve, (_, inside) in enumerate(study.solution_families(run), start=1):
        for first in range(0, len(inside), COLUMNS):
            cells = [
                _cell(found[answer], f"curve {curve}, place {k}")
                for k, answer in enumerate(inside[first : first + COLUMNS], start=1)
            ]
            rows.append({"label": str(curve), "cells": cells})
    return {
        "run": "many_starts",
        "label": "One target has many answers",
        "caption": "One target has many answers. Each row belongs to one curve; joint1 grows from "
        "left to right.",
        "rows": rows,
        "columns": [str(k + 1) for k in range(COLUMNS)],
    }


def _cell(record: dict[str, str], place: str) -> dict[str, Any]:
    """Return an answer as a cell of a map, whose numbers have at most four characters."""
    state = "accepted" if record["accepted"] == "yes" else "refused"
    numbers = [float(record[name].replace("−", "-")) for name in QUANTITIES]
    return {
        "answer": int(record["answer"]),
        "name": f"{place}, {state}",
        "tag": "×" if state == "refused" else "↓" * (record[TIP].startswith("−")),
        "state": state,
        "opens": state == "accepted",
        "sentence": f"Answer {record['answer']}, {state}.",
        "values": [*record.values()][1:],
        "numbers": numbers,
        "texts": [*map(short, numbers)],
    }


def short(value: float) -> str:
    """Return a number in at most four characters: a cell on a phone has no room for more."""
    if abs(value) >= 10:
        return f"{value:.0f}".replace("-", "−")
    text = f"{value:.{3 if value < 1 else 2}f}".rstrip("0").rstrip(".")
    return text.removeprefix("0") or "0"


def picture(run: Experiment, name: str) -> dict[str, Any]:
    """Return what reads a recorded view.

    Returns:
        `size`, `K`, `pose` (OpenCV axes), the `unit` of a depth [m], by number the
        `names`, heights of `planes` [m], centre and radius of `spheres` [m], the
        `columns` that are read, and of the `picture` its `name`, `alt` and `caption`.
    """
    view, numbers = view_of(run, name), run.readings[SEGMENTS]
    links = dict(enumerate(run.links, int(numbers["hand"]) - run.links.index("hand")))
    return {
        "size": view.size,
        "K": view.intrinsics.tolist(),
        "pose": other_axes(view.transform)[:3].tolist(),
        "unit": DEPTH_UNIT,
        "names": {0: "nothing"}
        | links
        | {numbers[name]: name for name in spec.SEGMENTS},
        "planes": {numbers["plane"]: 0.0},
        "spheres": {numbers["marker"]: [*spec.TARGET.tolist(), spec.MARKER_RADIUS]},
        "columns": READ,
        "picture": {"name": name} | PICTURES[name],
    }
