"""Figures of one joint: its response, its forces, and a state that is assigned or commanded."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from robo_genesis.core.palette import marks_of
from robo_genesis.core.plotting import LIMIT, TARGET, channel, finish, legend_above, look
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.sim import joint_channels
from robo_genesis.sim.joints import JointMap


def position(ax: Axes, traces: Mapping[str, Trace], joints: JointMap, joint: str) -> Axes:
    """Draw q of one joint for each trace, the common target and its settling band."""
    drawn, *_ = joint_channels.channels(traces, joints, joint)
    target, *_ = joint_channels.levels(traces, joints, joint, SETTLING_BAND)
    return channel(ax, next(iter(traces.values())).t, drawn, joint, [target])


def velocity(ax: Axes, traces: Mapping[str, Trace], joints: JointMap, joint: str) -> Axes:
    """Draw q̇ of one joint for each trace."""
    k = joints.entry(joint)
    for name, mark in marks_of(list(traces)).items():
        ax.plot(traces[name].t_step, traces[name].qd[:, k], label=name, **look(mark))
    return finish(ax, f"Velocity of {joint}", f"q̇ [{joints.position_units[k]}/s]")


def control_force(ax: Axes, traces: Mapping[str, Trace], joints: JointMap, joint: str) -> Axes:
    """Draw the control force of one joint for each trace, between the limits read back."""
    k = joints.entry(joint)
    limit = float(next(iter(traces.values())).effort_limit[k])
    for name, mark in marks_of(list(traces)).items():
        ax.plot(traces[name].t_step, traces[name].control_force[:, k], label=name, **look(mark))
    ax.axhline(limit, label="limit, read back", **LIMIT)
    ax.axhline(-limit, **LIMIT)
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
            legend_above(ax)  # marks belong in it, too
        ax.label_outer()
    return axes


def two_forces(ax: Axes, trace: Trace, joints: JointMap, joint: str) -> Axes:
    """Draw both force getters of one run: they answer different questions."""
    k = joints.entry(joint)
    drawn = look("baseline", label="get_dofs_control_force")
    ax.plot(trace.t_step, trace.control_force[:, k], **drawn)
    ax.plot(trace.t_step, trace.internal_force[:, k], **look("other", label="get_dofs_force"))
    limit = float(trace.effort_limit[k])
    ax.axhline(limit, label="limit, read back", **LIMIT)
    ax.axhline(-limit, **LIMIT)
    unit = joints.effort_units[k]
    return finish(ax, f"Forces on {joint}", f"force [{unit}]")


def assigned_and_commanded(
    ax: Axes, assigned: Trace, commanded: Trace, joints: JointMap, joint: str
) -> Axes:
    """Draw a state that is assigned at every step beside one that is commanded."""
    k = joints.entry(joint)
    ax.axhline(float(commanded.target[0, k]), label="target", **TARGET)
    written = look("other", label="state assigned: set_dofs_position")
    ax.plot(assigned.t, assigned.q[:, k], **written)
    measured = look("baseline", label="target commanded: control_dofs_position")
    ax.plot(commanded.t, commanded.q[:, k], **measured)
    unit = joints.position_units[k]
    return finish(ax, f"Assigned or commanded, {joint}", f"q [{unit}]", "lower right")
