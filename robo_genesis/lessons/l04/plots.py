"""Figures of lesson L04: functions of the experiment, and of axes; no numerics, no show()."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.palette import marks_of
from robo_genesis.core.plotting import LIMIT, TARGET, channel, finish, legend_above, look
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.spec import CASE_MARKS, STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import ASSIGNED, COMPARED
from robo_genesis.sim import joint_channels
from robo_genesis.sim.franka import LINK_PARENTS
from robo_genesis.sim.joints import JointMap


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured link origins."""
    return plotting.both_ends(run.frames) if run.rendered else links(run, "baseline")


def links(run: Experiment, name: str) -> Figure:
    """Draw the measured link origins at both ends of a run."""
    figure = Figure(figsize=(6, 5))
    plotting.schematic(figure.subplots(), run.traces[name], LINK_PARENTS)
    return figure


def assigned(run: Experiment) -> Figure:
    """Draw the stepped joint with assigned states and with a commanded target."""
    figure = Figure(figsize=(7, 3.8))
    both = run.traces[ASSIGNED], run.traces["baseline"]
    assigned_and_commanded(figure.subplots(), *both, run.joints, STEPPED_JOINT)
    return figure


def baseline(run: Experiment) -> Figure:
    """Draw position, velocity and control force of the stepped joint in the baseline."""
    figure = Figure(figsize=(7, 8))
    axes = figure.subplots(3, 1, sharex=True)
    response(axes, {"baseline": run.traces["baseline"]}, run.joints, STEPPED_JOINT)
    return figure


def compared(run: Experiment) -> Figure:
    """Draw position, velocity and control force of the stepped joint in the compared cases."""
    return _compared(run)


def compared_start(run: Experiment) -> Figure:
    """Draw the beginning of the same, enlarged, with a mark at every sample."""
    return _compared(run, until=0.35)


def _compared(run: Experiment, until: float | None = None) -> Figure:
    figure = Figure(figsize=(7, 8.5))
    traces = {name: run.traces[name] for name in COMPARED}
    response(figure.subplots(3, 1, sharex=True), traces, run.joints, STEPPED_JOINT, until)
    return figure


def baseline_forces(run: Experiment) -> Figure:
    """Draw both force getters of the baseline."""
    figure = Figure(figsize=(7, 3.8))
    two_forces(figure.subplots(), run.traces["baseline"], run.joints, STEPPED_JOINT)
    return figure


def position(ax: Axes, traces: Mapping[str, Trace], joints: JointMap, joint: str) -> Axes:
    """Draw q of one joint for each trace, the common target and its settling band."""
    drawn, *_ = joint_channels.channels(traces, joints, joint)
    target, *_ = joint_channels.levels(traces, joints, joint, SETTLING_BAND)
    return channel(ax, next(iter(traces.values())).t, drawn, joint, CASE_MARKS, [target])


def velocity(ax: Axes, traces: Mapping[str, Trace], joints: JointMap, joint: str) -> Axes:
    """Draw q̇ of one joint for each trace."""
    k = joints.entry(joint)
    for name, mark in marks_of(list(traces), CASE_MARKS).items():
        ax.plot(traces[name].t_step, traces[name].qd[:, k], label=name, **look(mark))
    return finish(ax, f"Velocity of {joint}", f"q̇ [{joints.position_units[k]}/s]")


def control_force(ax: Axes, traces: Mapping[str, Trace], joints: JointMap, joint: str) -> Axes:
    """Draw the control force of one joint for each trace, between the limits read back."""
    k = joints.entry(joint)
    for name, mark in marks_of(list(traces), CASE_MARKS).items():
        ax.plot(traces[name].t_step, traces[name].control_force[:, k], label=name, **look(mark))
    _limits(ax, next(iter(traces.values())), k)
    return finish(ax, f"Control force of {joint}", f"control force [{joints.effort_units[k]}]")


def response(
    axes: Sequence[Axes],
    traces: Mapping[str, Trace],
    joints: JointMap,
    joint: str,
    until: float | None = None,
) -> Sequence[Axes]:
    """Draw position, velocity and control force of one joint on three axes.

    `until` [s] shows the beginning alone, enlarged, with a mark at every sample.
    """
    for ax, draw in zip(axes, (position, velocity, control_force), strict=True):
        draw(ax, traces, joints, joint)
        if until is not None:
            ax.set_xlim(-0.01, until)
            for line in ax.get_lines():
                if np.size(line.get_xdata()) > 2:  # a curve of samples, not a limit
                    line.set(marker=".", markersize=6)
            legend_above(ax)  # again, with the marks
        ax.label_outer()
    return axes


def two_forces(ax: Axes, trace: Trace, joints: JointMap, joint: str) -> Axes:
    """Draw both force getters of one run: they answer different questions."""
    k = joints.entry(joint)
    drawn = look("baseline", label="get_dofs_control_force")
    ax.plot(trace.t_step, trace.control_force[:, k], **drawn)
    ax.plot(trace.t_step, trace.internal_force[:, k], **look("other", label="get_dofs_force"))
    _limits(ax, trace, k)
    return finish(ax, f"Forces on {joint}", f"force [{joints.effort_units[k]}]")


def _limits(ax: Axes, trace: Trace, k: int) -> None:
    limit = float(trace.effort_limit[k])
    ax.axhline(limit, label="limit, read back", **LIMIT)
    ax.axhline(-limit, **LIMIT)


def assigned_and_commanded(
    ax: Axes, assigned: Trace, commanded: Trace, joints: JointMap, joint: str
) -> Axes:
    """Draw a state that is assigned at every step and one that is commanded, over time."""
    k = joints.entry(joint)
    ax.axhline(float(commanded.target[0, k]), label="target", **TARGET)
    written = look("other", label="state assigned: set_dofs_position")
    ax.plot(assigned.t, assigned.q[:, k], **written)
    measured = look("baseline", label="target commanded: control_dofs_position")
    ax.plot(commanded.t, commanded.q[:, k], **measured)
    unit = joints.position_units[k]
    return finish(ax, f"Assigned or commanded, {joint}", f"q [{unit}]", "lower right")
