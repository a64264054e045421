"""Figures of L04's studies: functions of the experiment; no numerics, no show()."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.palette import PARTS
from robo_genesis.core.plotting import LINE, log_axis, look
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.spec import CASE_MARKS
from robo_genesis.lessons.l04.tables import ENGINE_LABELS

MEASURES = False

IDEAL = look("target", linestyle=(0, (4, 2)), linewidth=1.6)
"""The one dashed line of a figure: theory. Measured data have solid lines."""

ENGINE_STYLES = {
    "Genesis": look(CASE_MARKS["G2"], marker="o"),
    "MuJoCo implicitfast": look("other", marker="s"),
    "MuJoCo Euler": look("further", marker="^"),
}
"""All curves are G2's. Marker shapes distinguish the engines as well as colours."""


def step_size(run: Experiment) -> Figure:
    """Draw the response to both heights of the step over the ideal joint's, a case on each axes.

    The curve of the ideal joint is dashed.
    """
    t, figure = run.traces["G1"].t, plotting.figure(5.6)
    axes = figure.subplots(2, 1, sharex=True)
    for ax, name in zip(axes, study_spec.SMALL_STEPPED, strict=True):
        ax.axhline(1.0, **LINE)
        ax.plot(t, study.ideal(run, name).response(t), label="ideal joint", **IDEAL)
        small, large = study.share(run, name, "small"), study.share(run, name)
        ax.plot(t, small, label=f"+{study_spec.SMALL_STEP:g} rad", **look("other"))
        ax.plot(t, large, label=f"+{spec.STEP:g} rad", **look(CASE_MARKS[name]))
        ax.set(title=name, xlim=(0, 0.4), xlabel="time [s]", ylabel="share of the step")
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
