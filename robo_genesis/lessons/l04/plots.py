"""Figures of lesson L04: functions of the experiment; no numerics, no show()."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.palette import marks_of
from robo_genesis.core.plotting import BAND, LIMIT, LINE, look
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.spec import CASE_MARKS, ENTRY, STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import ASSIGNED, COMPARED, EXAMPLE
from robo_genesis.sim.arm.franka import LINK_PARENTS

MEASURES = False

START = 0.4  # End of the time axis where the compared cases differ [s]
BEFORE_REST = 0.6  # End of the time axis of the baseline [s]
DOTS = {"marker": ".", "markersize": 5}

Label = tuple[float, tuple[float, float]]
"""Time of the labelled sample [s], and where its text is relative to it [pt]."""

PANELS: Mapping[str, tuple[str, str, Mapping[str, Label]]] = {
    "position": ("q", "q [rad]",
                 {"G1": (0.11, (10, -18)), "G2": (0.15, (8, 3)), "G3": (0.1, (12, -12))}),
    "velocity": ("qd", "q̇ [rad/s]",
                 {"G1": (0.06, (-26, 6)), "G2": (0.1, (8, 0)), "G3": (0.11, (10, 2))}),
    "control force": ("control_force", "control force [N·m]",
                      {"G1": (0.09, (-24, -4)), "G2": (0.2, (-10, -16)), "G3": (0.1, (8, -24))}),
}  # fmt: skip
"""The array of a trace that each panel of a response shows, the label of its axis, and those of the
compared cases."""


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured link origins."""
    return plotting.robot_ends(run.frames, run.traces["baseline"], LINK_PARENTS)


def assigned(run: Experiment) -> Figure:
    """Draw the stepped joint with assigned states and with a commanded target, over time."""
    figure, ax = plotting.axes(3.4)
    written, commanded = run.traces[ASSIGNED], run.traces["baseline"]
    _target(ax, float(commanded.target[0, ENTRY]))
    crosses = look("other", linestyle="", marker="x", markersize=4)
    t, q = written.t[::4], written.q[::4, ENTRY]
    _curve(ax, t, q, crosses, "set_dofs_position", (0.6, (10, -20)))
    t, q = commanded.t, commanded.q[:, ENTRY]
    _curve(ax, t, q, look("baseline"), "control_dofs_position", (0.27, (2, -18)))
    _finish(ax, f"Assigned or commanded, {STEPPED_JOINT}", "q [rad]", float(t[-1]))
    return figure


def baseline(run: Experiment) -> Figure:
    """Draw position, velocity and control force of the stepped joint in the baseline."""
    return _response(7, {"baseline": run.traces["baseline"]}, BEFORE_REST)


def compared(run: Experiment) -> Figure:
    """Draw the beginning of the compared cases: position, velocity, control force of the joint."""
    return _response(8, {name: run.traces[name] for name in COMPARED}, START)


def _response(height: float, traces: Mapping[str, Trace], until: float) -> Figure:
    """Draw position, velocity and control force of the stepped joint up to `until` [s].

    The position has the common target and its settling band, the force the limits read back.
    """
    figure, first = plotting.figure(height), next(iter(traces.values()))
    position, velocity, force = axes = figure.subplots(3, 1, sharex=True)
    _target(position, float(first.target[0, ENTRY]), SETTLING_BAND)
    velocity.axhline(0, **LINE)
    _limits(force, first, until)
    for ax, (panel, (field, ylabel, labels)) in zip(axes, PANELS.items(), strict=True):
        for name, mark in marks_of(list(traces), CASE_MARKS).items():
            values = getattr(traces[name], field)[:, ENTRY]
            t = traces[name].t[-len(values) :]
            shown = t <= until
            _curve(ax, t[shown], values[shown], look(mark, **DOTS), name, labels.get(name))
        _finish(ax, f"{panel.capitalize()} of {STEPPED_JOINT}", ylabel, until)
        ax.label_outer()
    return figure


def baseline_forces(run: Experiment) -> Figure:
    """Draw both force getters of the baseline: they answer different questions."""
    (figure, ax), trace = plotting.axes(3.4), run.traces["baseline"]
    _limits(ax, trace, BEFORE_REST)
    for name, array, mark, label in (
        ("get_dofs_control_force", trace.control_force, "baseline", (0.14, (0, 32))),
        ("get_dofs_force", trace.internal_force, "other", (0.25, (4, -20))),
    ):
        _curve(ax, trace.t[1:], array[:, ENTRY], look(mark, **DOTS), name, label)
    _finish(ax, f"Forces on {STEPPED_JOINT}", "force [N·m]", BEFORE_REST)
    return figure


def defined(run: Experiment) -> Figure:
    """Draw the position of the example with its rise and settling time, overshoot, final error."""
    (figure, ax), trace, m = plotting.axes(4), run.traces[EXAMPLE], run.metrics[EXAMPLE]
    q = trace.q[:, ENTRY]
    _target(ax, float(trace.target[0, ENTRY]), SETTLING_BAND)
    ax.plot(trace.t, q, marker=".", markersize=6, **look("further"))
    for value, unit, time, name, height, start in (
        (m.rise_time, "s", m.rise_time, "rise time, 90 % of the step:", 0.2, (0.2, 1)),
        (m.settling_time, "s", m.settling_time,
         "settling time, in the band\nfrom here on:", 0.42, (0.35, 1)),
        (m.overshoot, "rad", trace.t[q.argmax()], "overshoot:", 0.94, (0, 0.5)),
        (m.final_error, "rad", START, "final error:", 0.62, (0.8, 1)),
    ):  # fmt: skip
        if time is not None:
            at = int(np.abs(trace.t - time).argmin())
            arrow = {"arrowstyle": "->", "color": LINE["color"], "linewidth": 0.9, "relpos": start}
            text, place = f"{name} {format_value(value, unit)}", (float(trace.t[at]), float(q[at]))
            ax.annotate(text, place, (0.98, height), textcoords="axes fraction", ha="right",
                        va="center", arrowprops=arrow)  # fmt: skip
    _finish(ax, f"Position of {STEPPED_JOINT} in the example", "q [rad]", START)
    return figure


def _curve(
    ax: Axes, t: FloatArray, values: FloatArray, style: Mapping[str, Any], name: str,
    label: Label | None,
) -> None:  # fmt: skip
    """Draw a curve, and with a label its name beside the sample that is nearest to a time."""
    ax.plot(t, values, **style)
    if label:
        time, offset = label
        n = int(np.abs(t - time).argmin())
        ax.annotate(name, (float(t[n]), float(values[n])), offset, textcoords="offset points",
                    color=style["color"], fontweight="bold")  # fmt: skip


def _target(ax: Axes, value: float, band: float | None = None) -> None:
    """Draw the target with its settling band, and name both: at the right edge below the band."""
    name, place, offset, side = "target", (0.0, value), (4, -4), "left"
    if band is not None:
        ax.axhspan(value - band, value + band, color=BAND, zorder=0)
        name, place, offset, side = f"target ±{band:g} rad", (1.0, value - band), (-4, -4), "right"
    ax.axhline(value, **LINE)
    ax.annotate(name, place, offset, xycoords=ax.get_yaxis_transform(),
                textcoords="offset points", ha=side, va="top")  # fmt: skip


def _limits(ax: Axes, trace: Trace, until: float) -> None:
    """Draw both limits that were read back, and name the upper one."""
    limit = float(trace.effort_limit[ENTRY])
    ax.axhline(limit, **LIMIT)
    ax.axhline(-limit, **LIMIT)
    ax.set_ylim(-1.25 * limit, 1.25 * limit)
    ax.annotate("limit, read back", (until, limit), (-4, 4), textcoords="offset points",
                ha="right", color=LIMIT["color"])  # fmt: skip


def _finish(ax: Axes, title: str, ylabel: str, until: float) -> None:
    ax.set(title=title, xlabel="time [s]", ylabel=ylabel, xlim=(-0.005, until))
