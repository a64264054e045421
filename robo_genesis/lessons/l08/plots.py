"""Figures of L08, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, legend_above, look
from robo_genesis.sim.arm import ladder, picking
from robo_genesis.sim.arm.franka import LINK_PARENTS
from robo_genesis.sim.arm.kinematics import hand_pose
from robo_genesis.sim.bodies.grippers import HeldCase
from robo_genesis.sim.bodies.soft_contact import depth_and_creep

from . import creep, metrics, spec

MEASURES = False

CONES = {"askew": "default cone", "round": "elliptic cone"}
OTHER = {"color": look("other")["color"]}


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the link origins of an episode."""
    return plotting.robot_ends(run, LINK_PARENTS)


def phases(run: Experiment) -> Figure:
    """Draw the height of the object and the phase of one episode over time."""
    figure = plotting.figure(4.4)
    above, below = figure.subplots(2, 1, sharex=True)
    trace, row = run.traces["askew"], spec.SHOWN["placed"]
    hand = hand_pose(trace.q[:, row]).position[:, 2]
    body = trace.object_pos[:, row, 2]
    for label, z, mark in (("hand", hand, "first"), ("object", body, "baseline")):
        above.plot(trace.t, 1000 * z, label=label, **look(mark))
    below.step(trace.t, trace.phase[:, row], where="post", **look("baseline"))
    below.set(
        yticks=range(len(picking.PHASES)), yticklabels=picking.PHASES, xlabel="time [s]"
    )
    plotting.label_ends(above, "Height of hand and object, and the phase", "z [mm]")
    return figure


def errors(run: Experiment, batch: str = "askew") -> Figure:
    """Draw the error of the believed place in each episode, marked by the rung it reaches."""
    figure, ax = plotting.axes(4.6)
    case = run.cases[batch]
    error = 1000 * (case.beliefs - case.starts)
    level = metrics.reached(run.traces[batch], case)
    for (name, mark), sign in zip(spec.CASE_MARKS.items(), "os^x", strict=True):
        own = error[level == spec.REACH[name]]
        style = {
            "color": look(mark)["color"],
            "markersize": 4,
            "label": spec.LABELS[name],
        }
        ax.plot(*own.T, sign, **style)
    ax.axvline(0, **LINE)
    ax.set(
        xlabel="error along the pads, x [mm]", ylabel="error across the pads, y [mm]"
    )
    legend_above(ax, "How episodes end, by their error")
    return figure


def slide(run: Experiment) -> Figure:
    """Draw how far the object is below its place in the hand at the start of the move."""
    figure, ax = plotting.axes(3.4)
    trace, row = run.traces["askew"], spec.SHOWN["placed"]
    held = (picking.LIFT, picking.MOVE, picking.LOWER)
    inside = np.flatnonzero(np.isin(trace.phase[:, row], held))
    above = metrics.hand_above(trace)[inside, row]
    ax.plot(trace.t[inside], 1000 * (above - above[0]), **look("baseline"))
    ax.set(xlabel="time [s]", ylabel="slid down [mm]")
    ax.set_title("Slide of the object in the closed fingers")
    return figure


def leaving(run: Experiment) -> Figure:
    """Draw how far objects are beyond the end of the pads while both fingers press, with
    both cones, from the beginning of closing.
    """
    figure, ax = plotting.axes(3.4)
    for name, mark in (("askew", "first"), ("round", "baseline")):
        trace = run.traces[name]
        beyond = np.abs(metrics.offset(trace)) - metrics.HALF_PAD
        closing = metrics.first_closing(trace)
        start = beyond[closing, np.arange(len(closing))]
        for row in np.flatnonzero((start > 5e-4) & (start < 2e-3)):
            held = ladder.pressed(trace)[:, row] & (trace.phase[:, row] <= picking.MOVE)
            times = trace.t[held] - trace.t[closing[row]]
            ax.semilogy(times, 1000 * beyond[held, row], **look(mark) | {"lw": 0.8})
        ax.plot([], [], label=CONES[name], **look(mark))
    t, rate = np.linspace(0, 1, 2), run.metrics["exact"].leaving
    ax.plot(t, 0.6 * np.exp(rate * t), ":", label="slope κ", **OTHER)
    ax.set(
        xlabel="time after closing begins [s]",
        ylabel="beyond the end [mm]",
        xlim=(0, 2),
    )
    ax.legend(loc="lower right")
    ax.set_title("Distance of cylinders beyond the end of the pads")
    return figure


# Label of each scanned setting.
AXES = {"friction": "friction µ", "force": "force of a pad [N]", "mass": "mass [kg]"}


def creep_scans(run: Experiment) -> Figure:
    """Draw the creep over friction, force and mass: measured as points, the formula dotted."""
    figure = plotting.figure(3.4)
    axes = figure.subplots(1, len(AXES), sharey=True)
    for ax, (setting, label) in zip(axes, AXES.items(), strict=True):
        names = [*creep.SCANS[setting]]
        values = [getattr(run.cases[name], setting) for name in names]
        ax.plot(
            values,
            [1000 * run.metrics[n].creep for n in names],
            "o",
            color=look("first")["color"],
        )
        fine = np.linspace(values[0], values[-1], 200)
        cases = [HeldCase(**{setting: value}) for value in fine]
        ax.plot(
            fine,
            [1000 * depth_and_creep(c)[1] for c in cases],
            ":",
            color=look("other")["color"],
        )
        ax.set_xlabel(label)
    axes[-1].axvline(creep.LIGHT, **LINE)
    axes[-1].annotate(
        "mg = µN", (creep.LIGHT, 0.1), rotation=90, va="bottom", ha="right"
    )
    axes[0].set(ylabel="creep [mm/s]", ylim=(0, None))
    return figure
