"""The names that the figure cells of L04's lecture use, from its bundle."""

from pathlib import Path
from typing import Any

from robo_genesis.evidence import bundle
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.lessons.l04 import spec

NOT_IN_BUNDLE = {"fig-l04-grid-overshoot", "fig-l04-grid-saturation", "fig-l04-film"}
"""The page has the runs of the grid as JSON, and the cell of the film compares the filmed run with
the recorded one."""

STUDIED = {"fig-l04-theory", "fig-l04-step-size", "fig-l04-convergence"}
"""Figures of all the page's traces; the others show the baseline's alone."""


def names(folder: Path) -> dict[str, Any]:
    experiment = from_bundle(folder, bundle.read_manifest(folder))
    runs = experiment.traces
    return {
        "experiment": experiment,
        "everything": runs,
        "baseline": runs["baseline"],
        "assigned": runs["assigned"],
        "compared": {case: runs[case] for case in ("G1", "G2", "G3")},
        "traces": {"baseline": runs["baseline"]},
        "joints": experiment.joints,
        "entry": spec.ENTRY,
    }


def before_cell(figure: str) -> str:
    return "traces = everything" if figure in STUDIED else ""
