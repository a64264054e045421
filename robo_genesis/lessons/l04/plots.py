"""Figures of lesson L04: functions of the experiment; no numerics, no show()."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.palette import PARTS, marks_of
from robo_genesis.core.plotting import BAND, LIMIT, LINE, log_axis, look
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.franka import LINK_PARENTS

from . import spec, study, study_spec
from .metrics import SETTLING_BAND
from .spec import CASE_MARKS, ENTRY, STEPPED_JOINT
from .study_spec import ASSIGNED, COMPARED, EXAMPLE
from .tables import ENGINE_LABELS

MEASURES = False

START = 0.4  # End of the time axis where the compared cases differ [s]
BEFORE_REST = 0.6  # End of the time axis of the baseline [s]
DOTS = {"marker": ".", "markersize": 5}

# The array of a trace that each panel of a response shows, and the label of its axis.
PANELS = {
    "position": ("q", "q [rad]"),
    "velocity": ("qd", "q̇ [rad/s]"),
    "control force": ("control_force", "control force [N·m]"),
}

# The one dashed line of a figure: theory. Measured data have solid lines.
IDEAL = look("target", linestyle=(0, (4, 2)), linewidth=1.6)

# All curves are G2's. Marker shapes distinguish the engines as well as colours.
ENGINE_STYLES = {
    "Genesis": look(CASE_MARKS["G2"], marker="o"),
    "MuJoCo implicitfast": look("other", marker="s"),
    "MuJoCo Euler": look("further", marker="^"),
}


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured link origins."""
    return plotting.robot_ends(run, LINK_PARENTS)


def assigned(run: Experiment) -> Figure:
    """Draw the stepped joint with assigned states and with a commanded target, over time."""
    figure, ax = plotting.axes(3.4)
    written, commanded = run.traces[ASSIGNED], run.traces["P1"]
    ax.axhline(commanded.target[0, ENTRY], label="target", **LINE)
    crosses = look("other", linestyle="", marker="x", markersize=4)
    ax.plot(written.t[::4], written.q[::4, ENTRY], label="set_dofs_position", **crosses)
    ax.plot(
        commanded.t,
        commanded.q[:, ENTRY],
        label="control_dofs_position",
        **look("baseline"),
    )
    plotting.finish(
        ax, f"Assigned or commanded, {STEPPED_JOINT}", "q [rad]", "lower right"
    )
    return figure


def baseline(run: Experiment) -> Figure:
    """Draw position, velocity and control force of the stepped joint in the baseline."""
    return _response(7, {"baseline": run.traces["baseline"]}, BEFORE_REST)


def compared(run: Experiment) -> Figure:
    """Draw the beginning of the compared cases: position, velocity, control force of the joint."""
    return _response(8, {name: run.traces[name] for name in COMPARED}, START)


def _response(height: float, traces: Mapping[str, Trace], until: float) -> Figure:
    """Draw position, velocity and control force of the stepped joint up to `until` [s].

    The position has the common target and its settling band, the force the limits read
    back.
    """
    figure, first = plotting.figure(height), next(iter(traces.values()))
    position, velocity, force = axes = figure.subplots(3, 1, sharex=True)
    _target(position, first)
    velocity.axhline(0, **LINE)
    limit = first.effort_limit[ENTRY]
    force.axhline(limit, label="limit, read back", **LIMIT)
    force.axhline(-limit, **LIMIT)
    for ax, (panel, (field, ylabel)) in zip(axes, PANELS.items(), strict=True):
        for name, mark in marks_of(traces, CASE_MARKS).items():
            values = getattr(traces[name], field)[:, ENTRY]
            t = traces[name].t[-len(values) :]
            shown = t <= until
            ax.plot(t[shown], values[shown], label=name, **look(mark, **DOTS))
        plotting.finish(ax, f"{panel.capitalize()} of {STEPPED_JOINT}", ylabel)
        ax.label_outer()
    return figure


def baseline_forces(run: Experiment) -> Figure:
    """Draw both force getters of the baseline: they answer different questions."""
    (figure, ax), trace = plotting.axes(3.4), run.traces["baseline"]
    ax.axhline(trace.effort_limit[ENTRY], label="limit, read back", **LIMIT)
    for name, array, mark in (
        ("get_dofs_control_force", trace.control_force, "baseline"),
        ("get_dofs_force", trace.internal_force, "other"),
    ):
        ax.plot(trace.t[1:], array[:, ENTRY], label=name, **look(mark, **DOTS))
    ax.set_xlim(-0.005, BEFORE_REST)
    ax.set_ylim(bottom=-60)  # room for both names: above the axes they need two lines
    plotting.finish(ax, f"Forces on {STEPPED_JOINT}", "force [N·m]", "lower right")
    return figure


def defined(run: Experiment) -> Figure:
    """Draw the position of the example with its rise and settling time, overshoot, final error."""
    (figure, ax), trace, m = plotting.axes(4), run.traces[EXAMPLE], run.metrics[EXAMPLE]
    q = trace.q[:, ENTRY]
    _target(ax, trace)
    ax.plot(trace.t, q, marker=".", markersize=6, **look("further"))
    settling = "settling time, in the band\nfrom here on:"
    arrow = {"arrowstyle": "->", "color": LINE["color"], "linewidth": 0.9}
    for value, unit, time, name, height, start in (
        (m.rise_time, "s", m.rise_time, "rise time, 90 % of the step:", 0.2, (0.2, 1)),
        (m.settling_time, "s", m.settling_time, settling, 0.42, (0.35, 1)),
        (m.overshoot, "rad", trace.t[q.argmax()], "overshoot:", 0.94, (0, 0.5)),
        (m.final_error, "rad", START, "final error:", 0.62, (0.8, 1)),
    ):
        if time is not None:
            at = np.abs(trace.t - time).argmin()
            ax.annotate(
                f"{name} {format_value(value, unit)}",
                (trace.t[at], q[at]),
                (0.98, height),
                textcoords="axes fraction",
                ha="right",
                va="center",
                arrowprops=arrow | {"relpos": start},
            )
    ax.set_xlim(-0.005, START)
    plotting.finish(ax, f"Position of {STEPPED_JOINT} in the example", "q [rad]")
    return figure


def _target(ax: Axes, trace: Trace) -> None:
    """Draw the target of the stepped joint in its settling band."""
    value = trace.target[0, ENTRY]
    ax.axhspan(value - SETTLING_BAND, value + SETTLING_BAND, color=BAND, zorder=0)
    ax.axhline(value, label=f"target ±{SETTLING_BAND:g} rad", **LINE)


# The deeper pages


def theory(run: Experiment) -> Figure:
    """Draw the compared cases over the ideal joint's response, one case on each axes."""
    start = spec.BASELINE.q_start[ENTRY]
    curves = {
        name: {"measured": (run.traces[name].q[:, ENTRY], CASE_MARKS[name])}
        for name in COMPARED
    }
    return _over_ideal(run, 7, curves, start, spec.STEP, f"q of {STEPPED_JOINT} [rad]")


def step_size(run: Experiment) -> Figure:
    """Draw the response to both heights of the step over the ideal joint's, a case on each axes.

    The curve of the ideal joint is dashed.
    """
    small, large = f"+{study_spec.SMALL_STEP:g} rad", f"+{spec.STEP:g} rad"
    curves = {
        name: {
            small: (study.share(run, name, "small"), "other"),
            large: (study.share(run, name), CASE_MARKS[name]),
        }
        for name in study_spec.SMALL_STEPPED
    }
    return _over_ideal(run, 5.6, curves, 0.0, 1.0, "share of the step")


def _over_ideal(
    run: Experiment,
    height: float,
    curves: Mapping[str, Mapping[str, tuple[FloatArray, str]]],
    start: float,
    step: float,
    ylabel: str,
) -> Figure:
    """Draw the beginning of responses over the ideal joint's, one case on each axes.

    Args:
        run: the experiment.
        height: of the figure [inch].
        curves: by case and label, a response (n+1,) and its mark in the palette.
        start: value at the start, in the unit of the responses.
        step: height of the step, in this unit.
        ylabel: their name.
    """
    figure = plotting.figure(height)
    axes = figure.subplots(len(curves), 1, sharex=True)
    for ax, (case, drawn) in zip(axes, curves.items(), strict=True):
        t, ideal = run.traces[case].t, study.ideal(run, case)
        ax.axhline(start + step, **LINE)
        ax.plot(t, start + step * ideal.response(t), label="ideal joint", **IDEAL)
        for label, (response, mark) in drawn.items():
            ax.plot(t, response, label=label, **look(mark))
        ax.set(title=case, xlim=(0, START), xlabel="time [s]", ylabel=ylabel)
        ax.legend(loc="lower right")
        ax.label_outer()
    return figure


def overshoot_by_step(run: Experiment) -> Figure:
    """Draw the overshoot of G2 over the solver's step for each engine.

    The mark of an unstable run is hollow, and no line leads there.
    """
    figure, ax = plotting.axes(3.8)
    substeps = study_spec.SUBSTEPS_STUDIED
    steps = 1000 * spec.G2.dt / np.array(substeps)
    for engine, label in ENGINE_LABELS.items():
        style = ENGINE_STYLES[label] | {"markersize": 6}
        hollow = np.array([study.unstable(run, engine, n) for n in substeps])
        values = np.array([*study.overshoot_by_substeps(run, engine).values()])
        ax.plot(steps[~hollow], values[~hollow], label=label, **style)
        if hollow.any():
            empty = style | {"linestyle": "", "markerfacecolor": PARTS["ground"].light}
            ax.plot(steps[hollow], values[hollow], label=f"{label}, unstable", **empty)
    ax.axvline(1000 * study.H, **LINE)
    ax.annotate(
        "the lesson's step",
        (1000 * study.H, 0),
        (-4, 4),
        textcoords="offset points",
        ha="right",
    )
    log_axis(ax, steps, "solver step h [ms]")
    ax.set_ylabel("overshoot of G2 [rad]")
    ax.set_ylim(0, 1.4 * ax.get_ylim()[1])  # space for the legend
    ax.legend(loc="upper left")
    return figure
