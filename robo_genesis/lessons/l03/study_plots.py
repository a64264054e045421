"""Figures of the lecture and the deeper pages: functions of the experiment."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, legend_above, log_axis, look
from robo_genesis.lessons.l03 import study, study_spec, theory
from robo_genesis.lessons.l03.metrics import CLEAR, clearance
from robo_genesis.lessons.l03.plots import STEP_LABEL, slides

MEASURES = False

STEP_MARKS = {
    "h_20000us": "second", "h_10000us": "third", "h_5000us": "baseline", "h_125us": "first",
}  # fmt: skip
RELEASE_MARKS = {"release_10ms": "baseline", "release_5ms": "first", "release_2ms": "second"}
"""Marks of the palette by scene; the landing from the baseline's height is drawn."""

CONES = {
    "low_on_050": look("first", label="pyramid, μ = 0.5"),
    "high_on_050": look("second", label="pyramid, μ = 0.8"),
    "low_on_050_elliptic": look("third", label="elliptic, μ = 0.5"),
    "high_on_050_elliptic": look("other", label="elliptic, μ = 0.8"),
}
LANES = {"low": ("first", "μ = 0.5"), "high": ("second", "μ = 0.8")}
"""Mark and label of each cube."""


def formula(mark: str) -> dict[str, Any]:
    """Return the line style of a formula: dotted, in the colour of a mark."""
    return {"color": look(mark)["color"], "linestyle": ":", "linewidth": 1.4}


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


def hops(run: Experiment) -> Figure:
    """Draw the hops by solver step and by speed, with the formula of one step."""
    figure = plotting.figure(7)
    by_step, by_speed = figure.subplots(2, 1)
    for lane, (mark, label) in LANES.items():
        names = [f"{step}_{lane}" for step in study_spec.HOP_STEP_CASES]
        h = {name: 1000 * run.cases[name].h for name in names}
        draw_hops(by_step, run, h, mark, label)
    log_axis(by_step, {*h.values()} - {2}, STEP_LABEL)
    by_step.legend(loc="lower right")
    speeds = {name: case.speed for name, case in study_spec.HOP_SPEED_CASES.items()}
    draw_hops(by_speed, run, speeds, "first")
    log_axis(by_speed, speeds.values(), "speed of the push [m/s]")
    for ax, title in ((by_step, "Push at 2 m/s"), (by_speed, "h = 5 ms, μ = 0.5")):
        ax.set(title=title, ylabel="hop [mm]", yscale="log", ylim=(0.01, 100))
        ax.set_yticks([0.01, 0.1, 1, 10, 100], ["0.01", "0.1", "1", "10", "100"])
        ax.minorticks_off()
    return figure


def draw_hops(
    ax: Axes, run: Experiment, at: Mapping[str, float], mark: str, label: str = ""
) -> None:
    """Draw hops as dots, and the formula, over a value of each run."""
    x, found = [*at.values()], [1000 * run.metrics[name].hop for name in at]
    ax.plot(x, found, "o", color=look(mark)["color"], label=label)
    ax.plot(x, [1000 * theory.hop(run.cases[name]) for name in at], **formula(mark))


def cones(run: Experiment) -> Figure:
    """Draw speed, clearance and angular speed with both friction models."""
    return slides(run, CONES)


def stops(run: Experiment) -> Figure:
    """Draw the stopping distances of both pushed cubes by solver step, beside Coulomb's."""
    figure, ax = plotting.axes(3.4)
    for lane, (mark, label) in LANES.items():
        found = study.stops_of_lane(run, lane)
        h = [1000 * run.cases[name].h for name in found]
        distances = [np.nan if of is None else of for of in found.values()]
        ax.plot(h, distances, "o-", color=look(mark)["color"], label=label)
        ax.axhline(theory.coulomb_distance(run.cases[study.LANES[lane]]), **formula(mark))
    ax.set(ylabel="stopping distance [m]", ylim=(0.15, 0.5))
    log_axis(ax, (0.1, 0.25, 0.5, 1, 2.5, 5), STEP_LABEL)
    legend_above(ax, "Dotted: v² / (2 μ g)")
    return figure


def releases(run: Experiment) -> Figure:
    """Draw the landing from the baseline's height for three time constants, beside the theory."""
    figure, ax = plotting.axes(3.8)
    for scene, mark in RELEASE_MARKS.items():
        name = f"{scene}_10000"
        case, trace = run.cases[name], run.traces[name]
        t = 1000 * (trace.t - np.sqrt(2 * (case.start[2] - case.rest_height) / case.gravity))
        colour, seconds = look(mark)["color"], theory.contact_seconds(case)
        label = f"T = {1000 * seconds:g} ms"
        ax.plot(t, 1000 * clearance(trace, case), color=colour, label=label)
        ideal = np.linspace(0, 2 * seconds, 80)
        depth = theory.impact_speed(case) * ideal * np.exp(-ideal / seconds)
        ax.plot(1000 * ideal, -1000 * depth, **formula(mark))
        ax.plot(2000 * seconds, -1000 * depth[-1], "o", color=colour, markersize=5)
    ax.axhline(0, **LINE)
    ax.set(xlim=(-5, 55), ylim=(-9, 4), xlabel="time after touchdown [ms]")
    ax.set_ylabel("clearance [mm]")
    legend_above(ax, "Dotted: linear contact")
    return figure
