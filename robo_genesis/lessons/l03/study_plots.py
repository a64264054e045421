"""Figures of the lecture and the deeper pages: functions of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, legend_above, log_axis, look
from robo_genesis.lessons.l03 import study, study_spec, theory
from robo_genesis.lessons.l03.metrics import CLEAR, clearance
from robo_genesis.lessons.l03.plots import STEP_LABEL

MEASURES = False

STEP_MARKS = {
    "h_20000us": "second", "h_10000us": "third", "h_5000us": "baseline", "h_125us": "first",
}  # fmt: skip
"""Marks of the palette by scene; the landing from the baseline's height is drawn."""


def landings_by_step(run: Experiment) -> Figure:
    """Draw the landing from the baseline's height at four solver steps."""
    figure, ax = plotting.axes(3.6)
    for scene, mark in STEP_MARKS.items():
        case, trace = run.cases[f"{scene}_10000"], run.traces[f"{scene}_10000"]
        every = max(1, round(0.001 / trace.dt))
        style = look(mark, marker="." if case.h > 0.002 else "")
        clear = 1000 * clearance(trace, case)[::every]
        ax.plot(trace.t[::every], clear, label=f"h = {1000 * case.h:g} ms", **style)
    ax.axhline(0, **LINE)
    ax.set(xlim=(0.2, 0.34), ylim=(-26, 14), xlabel="time [s]", ylabel="clearance [mm]",
           title="Below zero: overlap")  # fmt: skip
    ax.legend(loc="lower right")
    return figure


def deepest(run: Experiment) -> Figure:
    """Show two cubes at their deepest samples, without a camera the landings at four steps."""
    if not run.rendered:
        return landings_by_step(run)
    words = study_spec.DEEPEST.items()
    return plotting.stacked({text: run.frames[name][120:420] for name, text in words})


def depths_by_step(run: Experiment) -> Figure:
    """Draw each depth as a share of v T / e by the solver step."""
    figure, ax = plotting.axes(3.8)
    points = np.array([
        (1000 * case.h, found.penetration / theory.depth(case), found.rebound > CLEAR)
        for _, case, found in study.row(run, *study_spec.STEP_CASES)
    ])  # fmt: skip
    for label, rebounds, marker, size, mark in (
        ("stays down", False, "o", 4.5, "first"),
        ("leaves the surface again", True, "^", 6, "second"),
    ):
        h, shares, _ = points[points[:, 2] == rebounds].T
        ax.plot(h, shares, marker, markersize=size, color=look(mark)["color"], label=label)
    ax.axhline(1, label="v T / e", **look("target"))
    log_axis(ax, points[:, 0], STEP_LABEL)
    ax.set_ylim(bottom=0)
    ax.set_ylabel("depth / (v T / e)")
    legend_above(ax, "Nine heights")
    return figure
