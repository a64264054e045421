"""Figures of L04's studies: functions of the experiment; no numerics, no show()."""

from collections.abc import Mapping

import numpy as np
from matplotlib.colors import LinearSegmentedColormap, to_rgba
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.palette import MARKS, PARTS
from robo_genesis.core.plotting import LINE, log_axis, look
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.explorer import NAMES
from robo_genesis.lessons.l04.spec import CASE_MARKS
from robo_genesis.lessons.l04.study_spec import KP, KV, SMALL_STEP, STEP_SIZES, GridPoint
from robo_genesis.lessons.l04.tables import ENGINE_LABELS

MEASURES = False

IDEAL = look("target", linestyle=(0, (4, 2)), linewidth=1.6)
"""The one dashed line of a figure: theory. Measured data have solid lines."""

SHADES = LinearSegmentedColormap.from_list(
    "shades", [to_rgba(MARKS["first"].light, alpha) for alpha in (0, 0.45)]
)
"""From nothing to a colour that covers the ground in part: text is readable on it in any theme."""

ENGINE_STYLES = {
    "Genesis": look(CASE_MARKS["G2"], marker="o"),
    "MuJoCo implicitfast": look("other", marker="s"),
    "MuJoCo Euler": look("further", marker="^"),
}
"""All curves are G2's. Marker shapes distinguish the engines as well as colours."""


def theory(run: Experiment) -> Figure:
    """Draw the compared cases over the ideal joint's response, one case on each axes."""
    start, t = float(spec.BASELINE.q_start[spec.ENTRY]), run.traces["G1"].t
    curves = {
        name: {
            "ideal joint": start + spec.STEP * study.ideal(run, name).response(t),
            "measured": run.traces[name].q[:, spec.ENTRY],
        }
        for name in study_spec.COMPARED
    }
    return _beside_ideal(7, t, curves, start + spec.STEP, "q of joint4 [rad]")


def step_size(run: Experiment) -> Figure:
    """Draw the response to both heights of the step beside the ideal joint's."""
    t = run.traces["G1"].t
    shares = {
        name: {
            "ideal joint": study.ideal(run, name).response(t),
            f"+{SMALL_STEP:g} rad": study.share(run, name, "small"),
            f"+{spec.STEP:g} rad": study.share(run, name),
        }
        for name in study_spec.SMALL_STEPPED
    }
    return _beside_ideal(5.6, t, shares, 1.0, "share of the step")


def _beside_ideal(
    height: float,
    t: FloatArray,
    curves: Mapping[str, Mapping[str, FloatArray]],
    target: float,
    ylabel: str,
) -> Figure:
    """Draw the curves (n+1,) of each case over `t` [s], one case on each axes.

    The curve of the ideal joint is dashed, the last one has the colour of its case.
    """
    figure = plotting.figure(height)
    axes = figure.subplots(len(curves), 1, sharex=True)
    for ax, (name, of_case) in zip(axes, curves.items(), strict=True):
        ax.axhline(target, **LINE)
        for label, curve in of_case.items():
            last = look(CASE_MARKS[name] if label == [*of_case][-1] else "other")
            ax.plot(t, curve, label=label, **(IDEAL if label == "ideal joint" else last))
        ax.set(title=name, xlim=(0, 0.4), xlabel="time [s]", ylabel=ylabel)
        ax.legend(loc="lower right")
        ax.label_outer()
    return figure


def overshoot_by_step(run: Experiment) -> Figure:
    """Draw the overshoot of G2 over the solver's step for each engine.

    The mark of an unstable run is hollow, and no line leads there.
    """
    figure, ax = plotting.axes(3.8)
    steps = 1000 * spec.G2.dt / np.array(study_spec.SUBSTEPS_STUDIED)
    for engine, label in ENGINE_LABELS.items():
        style = ENGINE_STYLES[label] | {"markersize": 6}
        found = study.overshoot_by_substeps(run, engine)
        hollow = np.array([study.unstable(run, engine, n) for n in found])
        values = np.array([*found.values()])
        ax.plot(steps[~hollow], values[~hollow], label=label, **style)
        if hollow.any():
            empty = style | {"linestyle": "", "markerfacecolor": PARTS["ground"].light}
            ax.plot(steps[hollow], values[hollow], label=f"{label}, unstable", **empty)
    ax.axvline(1000 * study.H, **LINE)
    ax.annotate("the lesson's step", (1000 * study.H, 0), (-4, 4), textcoords="offset points",
                ha="right")  # fmt: skip
    log_axis(ax, steps, "solver step h [ms]")
    ax.set_ylabel("overshoot of G2 [rad]")
    ax.set_ylim(0, 1.4 * ax.get_ylim()[1])  # space for the legend
    ax.legend(loc="upper left")
    return figure


def grid_saturation(run: Experiment) -> Figure:
    """Draw the number of saturated samples of each run of the grid.

    One step size on each axes, KP upwards, KV to the right, one colour scale for all, from zero.
    Readers read the number in a cell, the colour only helps.
    """
    figure = plotting.figure(6.8)
    counts = [run.metrics[point.name].saturation_samples for point in study_spec.POINTS]
    maps = np.reshape(counts, (len(STEP_SIZES), len(KP), len(KV)))
    for ax, step, cells in zip(figure.subplots(2, 2).flat, STEP_SIZES, maps, strict=True):
        lines = {"edgecolors": PARTS["grid"].light, "linewidth": 1}
        ax.pcolormesh(cells, cmap=SHADES, vmin=0, vmax=maps.max(), **lines)
        for (row, column), count in np.ndenumerate(cells):
            name = NAMES.get(GridPoint(step, KP[row], KV[column]))
            text = f"{name}\n{count}" if name else f"{count}"
            ax.text(column + 0.5, row + 0.5, text, ha="center", va="center")
        ax.grid(visible=False)
        ax.set_xticks(np.arange(len(KV)) + 0.5, [f"{value:g}" for value in KV])
        ax.set_yticks(np.arange(len(KP)) + 0.5, [f"{value:g}" for value in KP])
        ax.set(title=f"step {step:g} rad", xlabel="KV [N·m·s/rad]", ylabel="KP [N·m/rad]")
        ax.label_outer()
    return figure
