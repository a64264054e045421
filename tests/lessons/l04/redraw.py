"""The names that figure cells of L04 use, from the bundle of their page."""

from pathlib import Path
from typing import Any

from robo_genesis.evidence import bundle
from robo_genesis.evidence.reader import Reader
from robo_genesis.evidence.trace_files import read_joints, read_trace
from robo_genesis.lessons.l04 import recompute, spec

NOT_IN_BUNDLE = {"fig-l04-grid-overshoot", "fig-l04-grid-saturation", "fig-l04-film"}
"""The page has the runs of the grid as JSON, and the cell of the film compares the filmed run with
the recorded one."""

STUDIED = {"fig-l04-theory", "fig-l04-step-size", "fig-l04-convergence"}
"""Figures of all the page's traces; the others show the baseline's alone."""


def names(folder: Path) -> dict[str, Any]:
    arrays = bundle.read_arrays(folder)
    runs = {case: read_trace(folder, arrays, case) for case in arrays.cases}
    joints = read_joints(arrays)
    found = {
        "baseline": runs["baseline"],
        "assigned": runs.get("assigned"),
        "compared": {case: runs[case] for case in ("G1", "G2", "G3")},
        "traces": {"baseline": runs["baseline"]},
        "joints": joints,
        "entry": joints.entry(spec.STEPPED_JOINT),
    }
    if folder.parent.name == "lab":
        return found
    reader = Reader(folder, bundle.read_manifest(folder))
    return found | {"found": recompute.read_studies(reader, runs), "everything": runs}


def before_cell(figure: str) -> str:
    return "traces = everything" if figure in STUDIED else ""
