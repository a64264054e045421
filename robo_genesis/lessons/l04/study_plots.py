"""Figures of L04's studies: functions of the experiment, and of axes; no numerics, no show()."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_rgba
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.palette import MARKS, PARTS
from robo_genesis.core.plotting import LINE, look
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l04 import spec, study
from robo_genesis.lessons.l04.engine_comparison import ENGINE_LABELS
from robo_genesis.lessons.l04.explorer import cell_labels
from robo_genesis.lessons.l04.plots import solid
from robo_genesis.lessons.l04.spec import CASE_MARKS
from robo_genesis.lessons.l04.study_spec import (
    COMPARED,
    KP,
    KV,
    POINTS,
    SMALL_STEP,
    SMALL_STEPPED,
    STEP_SIZES,
)

MEASURES = False

IDEAL = look("target", linestyle=(0, (4, 2)), linewidth=1.6)
"""The one dashed line of a figure: theory. Measured data have solid lines."""

SHADES = LinearSegmentedColormap.from_list(
    "shades", [to_rgba(MARKS["first"].light, alpha) for alpha in (0, 0.45)]
)
"""From nothing to a colour that covers the ground in part: text is readable on it in any theme."""

ENGINE_STYLES = {
    "Genesis": solid(CASE_MARKS["G2"], marker="o"),
    "MuJoCo implicitfast": solid("other", marker="s"),
    "MuJoCo Euler": solid("further", marker="^"),
}
"""All curves are G2's. Marker shapes distinguish the engines as well as colours."""


def theory(run: Experiment) -> Figure:
    """Draw the compared cases over the ideal joint's response."""
    figure = plotting.figure(7)
    start, t = float(spec.BASELINE.q_start[spec.ENTRY]), run.traces["G1"].t
    beside_ideal(
        figure.subplots(3, 1, sharex=True),
        t,
        {name: run.traces[name].q[:, spec.ENTRY] for name in COMPARED},
        {name: start + spec.STEP * study.ideal(run, name).response(t) for name in COMPARED},
        target=start + spec.STEP,
        until=0.4,
    )
    return figure


def step_size(run: Experiment) -> Figure:
    """Draw the response to both heights of the step beside the ideal joint's."""
    figure, t = plotting.figure(5.6), run.traces["G1"].t
    shares = {
        name: {
            "ideal joint": study.ideal(run, name).response(t),
            f"+{SMALL_STEP:g} rad": study.share(run, name, "small"),
            f"+{spec.STEP:g} rad": study.share(run, name),
        }
        for name in SMALL_STEPPED
    }
    step_sizes(figure.subplots(2, 1, sharex=True), t, shares, until=0.4)
    return figure


def overshoot_by_step(run: Experiment) -> Figure:
    """Draw the overshoot of G2 over the solver's step for each engine."""
    figure = plotting.figure(3.8)
    curves = {
        ENGINE_LABELS[engine]: {
            1000 * spec.G2.dt / n: (value, study.unstable(run, engine, n))
            for n, value in study.overshoot_by_substeps(run, engine).items()
        }
        for engine in study.ENGINES
    }
    convergence(figure.subplots(), curves, declared=1000 * spec.G2.dt / spec.G2.substeps)
    return figure


def grid_saturation(run: Experiment) -> Figure:
    """Draw the number of saturated samples of each run of the grid."""
    counts = [run.metrics[point.name].saturation_samples for point in POINTS]
    return _grid(np.array(counts), [str(count) for count in counts])


def _grid(values: FloatArray, numbers: Sequence[str]) -> Figure:
    figure = plotting.figure(6.8)
    axes = list(figure.subplots(2, 2).flat)
    grid_maps(axes, values, cell_labels(numbers), STEP_SIZES, KP, KV)
    return figure


def beside_ideal(
    axes: Sequence[Axes],
    t: FloatArray,
    measured: Mapping[str, FloatArray],
    ideal: Mapping[str, FloatArray],
    target: float,
    until: float,
) -> Sequence[Axes]:
    """Draw each case's measured position [rad] over the ideal joint's, one case on each axes.

    All arrays (n+1,) over `t` [s], shown up to `until` [s].
    """
    for ax, (name, q) in zip(axes, measured.items(), strict=True):
        ax.axhline(target, **LINE)
        ax.plot(t, ideal[name], label="ideal joint", **IDEAL)
        ax.plot(t, q, label="measured", **solid(CASE_MARKS[name]))
        _finish_case(ax, name, "q of joint4 [rad]", until)
    return axes


def step_sizes(
    axes: Sequence[Axes],
    t: FloatArray,
    shares: Mapping[str, Mapping[str, FloatArray]],
    until: float,
) -> Sequence[Axes]:
    """Draw responses as shares of their step, one case on each axes, one curve a label.

    A curve called `ideal joint` is drawn as such. All arrays (n+1,) over `t` [s].
    """
    for ax, (name, curves) in zip(axes, shares.items(), strict=True):
        ax.axhline(1.0, **LINE)
        measured = iter((solid("other"), solid(CASE_MARKS[name])))
        for label, curve in curves.items():
            ax.plot(t, curve, label=label, **(IDEAL if label == "ideal joint" else next(measured)))
        _finish_case(ax, name, "share of the step", until)
    return axes


def _finish_case(ax: Axes, title: str, ylabel: str, until: float) -> None:
    ax.set_title(title, loc="left")
    ax.set(xlim=(0, until), xlabel="time [s]", ylabel=ylabel)
    ax.legend(loc="lower right")
    ax.label_outer()


def convergence(
    ax: Axes, overshoot: Mapping[str, Mapping[float, tuple[float, bool]]], declared: float
) -> Axes:
    """Draw overshoot [rad] over the solver's step [ms], one curve for each engine.

    Each value comes with whether its run is unstable: such a mark is hollow, and no line leads
    there. `declared` [ms] marks the step of the lesson's own runs.
    """
    for name, values in overshoot.items():
        style = ENGINE_STYLES[name] | {"markersize": 6}
        stable = {h: v for h, (v, unstable) in values.items() if not unstable}
        ax.plot(list(stable), list(stable.values()), label=name, **style)
        hollow = {h: v for h, (v, unstable) in values.items() if unstable}
        if hollow:
            empty = style | {"linestyle": "", "markerfacecolor": PARTS["ground"].light}
            ax.plot(list(hollow), list(hollow.values()), label=f"{name}, unstable", **empty)
    ax.axvline(declared, **LINE)
    ax.annotate("the lesson's step", (declared, 0), (-4, 4), textcoords="offset points", ha="right")
    ax.set(xscale="log", xlabel="solver step h [ms]", ylabel="overshoot of G2 [rad]")
    steps = sorted({h for values in overshoot.values() for h in values})
    ax.set_xticks(steps, [f"{h:g}" for h in steps])
    ax.minorticks_off()
    ax.set_ylim(0, 1.4 * ax.get_ylim()[1])  # space for the legend
    ax.legend(loc="upper left")
    return ax


def grid_maps(
    axes: Sequence[Axes],
    values: FloatArray,
    labels: Sequence[str],
    steps: Sequence[float],
    kp: Sequence[float],
    kv: Sequence[float],
) -> Sequence[Axes]:
    """Draw one value a point of a grid, one step size on each axes, KP upwards, KV to the right.

    Args:
        axes: as many as steps.
        values: (points,) in the grid's order; one colour scale for all, from zero.
        labels: (points,), the text in each cell: readers read the number, the colour only helps.
        steps: step sizes [rad].
        kp: gains of the rows [N·m/rad].
        kv: gains of the columns [N·m·s/rad].
    """
    shape, highest = (len(steps), len(kp), len(kv)), float(np.max(values))
    maps, texts = np.reshape(values, shape), np.reshape(np.array(labels), shape)
    for number, (ax, step) in enumerate(zip(axes, steps, strict=True)):
        ax.pcolormesh(
            maps[number],
            cmap=SHADES,
            vmin=0,
            vmax=highest,
            edgecolors=PARTS["grid"].light,
            linewidth=1,
        )
        for (row, column), text in np.ndenumerate(texts[number]):
            x, y = column + 0.5, row + 0.5
            ax.text(x, y, text, ha="center", va="center")
        ax.grid(visible=False)
        ax.set_xticks(np.arange(len(kv)) + 0.5, [f"{value:g}" for value in kv])
        ax.set_yticks(np.arange(len(kp)) + 0.5, [f"{value:g}" for value in kp])
        ax.set_title(f"step {step:g} rad", loc="left")
        ax.set(xlabel="KV [N·m·s/rad]", ylabel="KP [N·m/rad]")
        ax.label_outer()
    return axes
