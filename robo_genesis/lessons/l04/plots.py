"""Figures of lesson L04: functions of the experiment, and of axes; no numerics, no show()."""

import io
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.palette import marks_of
from robo_genesis.core.plotting import LIMIT, TARGET, channel, finish, legend_above, look
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.spec import CASE_MARKS, STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import COMPARED
from robo_genesis.sim import joint_channels
from robo_genesis.sim.franka import LINK_PARENTS
from robo_genesis.sim.joints import JointMap

IDEAL = look("target", linestyle=(0, (1, 1.2)), linewidth=1.8)
ENGINE_STYLES = {
    "Genesis": look(CASE_MARKS["G2"], linestyle="-", marker="o"),
    "MuJoCo implicitfast": look("other", marker="s"),
    "MuJoCo Euler": look("further", marker="^"),
}
"""All curves are G2's. Marker shapes distinguish the engines as well as colours."""

JPEG_QUALITY = 70
"""JPEG quality: high enough that no blocks are visible at the printed size."""

FILM_VIEW = (slice(140, 420), slice(270, 550))
"""Rows and columns of a frame that show the robot [pixel]."""


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured link origins."""
    if run.rendered:
        return plotting.both_ends(run.frames)
    figure = Figure(figsize=(6, 5))
    plotting.schematic(figure.subplots(), run.traces["baseline"], LINK_PARENTS)
    return figure


def baseline(run: Experiment) -> Figure:
    """Draw position, velocity and control force of the stepped joint in the baseline."""
    figure = Figure(figsize=(7, 8))
    axes = figure.subplots(3, 1, sharex=True)
    response(axes, {"baseline": run.traces["baseline"]}, run.joints, STEPPED_JOINT)
    return figure


def compared(run: Experiment) -> Figure:
    """Draw position, velocity and control force of the stepped joint in the compared cases."""
    figure = Figure(figsize=(7, 8.5))
    traces = {name: run.traces[name] for name in COMPARED}
    response(figure.subplots(3, 1, sharex=True), traces, run.joints, STEPPED_JOINT)
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
        ax.axhline(target, label="target", **TARGET)
        ax.plot(t, ideal[name], label="ideal joint", **IDEAL)
        ax.plot(t, q, label="measured", **look(CASE_MARKS[name]))
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
        ax.axhline(1.0, **TARGET)
        measured = iter((look("other"), look(CASE_MARKS[name])))
        for label, curve in curves.items():
            ax.plot(t, curve, label=label, **(IDEAL if label == "ideal joint" else next(measured)))
        _finish_case(ax, name, "share of the step", until)
    return axes


def _finish_case(ax: Axes, title: str, ylabel: str, until: float) -> None:
    ax.set_title(title, loc="left")
    ax.set(xlim=(0, until), xlabel="time [s]", ylabel=ylabel)
    ax.legend(fontsize="small", loc="lower right")
    ax.label_outer()


def convergence(ax: Axes, overshoot: Mapping[str, Mapping[float, float]], declared: float) -> Axes:
    """Draw overshoot [rad] over the solver's step [s], one curve an engine, the finest at the left.

    `declared` [s] marks the step of the lesson's own runs.
    """
    for name, values in overshoot.items():
        drawn = ENGINE_STYLES[name] | {"label": name, "markersize": 6}
        ax.plot(list(values), list(values.values()), **drawn)
    ax.axvline(declared, label="the lesson's step", **TARGET)
    ax.set(xscale="log", xlabel="solver step [s]", ylabel="overshoot of G2 [rad]")
    ax.set_ylim(bottom=0)
    ax.legend(fontsize="small", loc="upper left")
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
            maps[number], cmap="Blues", vmin=0, vmax=highest, edgecolors="#d9d9d9", linewidth=1
        )
        for (row, column), text in np.ndenumerate(texts[number]):
            color = "white" if maps[number, row, column] > 0.55 * highest else "black"
            x, y = column + 0.5, row + 0.5
            ax.text(x, y, text, ha="center", va="center", fontsize="small", color=color)
        ax.grid(visible=False)
        ax.set_xticks(np.arange(len(kv)) + 0.5, [f"{value:g}" for value in kv])
        ax.set_yticks(np.arange(len(kp)) + 0.5, [f"{value:g}" for value in kp])
        ax.set_title(f"step {step:g} rad", loc="left")
        ax.set(xlabel="KV [N·m·s/rad]", ylabel="KP [N·m/rad]")
        ax.label_outer()
    return axes


def film_strip(axes: Sequence[Axes], frames: Mapping[int, np.ndarray], dt: float) -> Sequence[Axes]:
    """Show frames by sample number, each below its time [s]."""
    for ax, (sample, frame) in zip(axes, sorted(frames.items()), strict=True):
        ax.imshow(frame[FILM_VIEW])
        ax.set_axis_off()
        ax.set_title(f"t = {sample * dt:.2f} s", fontsize="small")
    return axes


def jpeg(figure: Figure) -> bytes:
    """Return a figure of photographs as JPEG: an SVG file would be ten times as large."""
    stream = io.BytesIO()
    figure.savefig(stream, format="jpeg", dpi=90, pil_kwargs={"quality": JPEG_QUALITY})
    return stream.getvalue()
