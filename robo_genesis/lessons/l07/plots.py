"""Figures of L07, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, look
from robo_genesis.lessons.l07 import rungs, spec
from robo_genesis.lessons.l07.metrics import OBJECT, WINDOW
from robo_genesis.sim.arm.franka import LINK_PARENTS
from robo_genesis.sim.arm.lifting import ENDS

MEASURES = False


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the link origins of scene A."""
    return plotting.robot_ends(run.frames, run.traces["baseline"], LINK_PARENTS)


def views(run: Experiment) -> Figure:
    """Show what both cameras see of scene A, without a camera its link origins."""
    if not run.rendered:
        return posture(run)
    return plotting.stacked({name: run.frames[f"{name}_rgb"] for name in rungs.CAMERAS})


def settling(run: Experiment) -> Figure:
    """Draw the gap below the objects of scenes A and B."""
    figure, ax = plotting.axes(3.4)
    for name, mark in (("baseline", "baseline"), ("hovering", "first")):
        trace, case = run.traces[f"{name}_at_rest"], spec.SCENES[name]
        gap = 1000 * (trace.link_pos[:, OBJECT, 2] - case.size[2] / 2 - case.place[2])
        ax.plot(trace.t, gap, label=f"scene {spec.LETTERS[name]}", **look(mark))
    ax.axvline(trace.t[-WINDOW - 1], **LINE)
    ax.set(xlabel="time [s]", ylabel="gap below [mm]")
    plotting.label_ends(ax, "Gap between object and table")
    return figure


def lifts(run: Experiment) -> Figure:
    """Draw the rise of the objects after the fingers have closed."""
    figure, ax = plotting.axes(3.6)
    marks = ("baseline", "first", "second", "third")
    for (name, label), mark in zip(spec.SHOWN_LIFTS.items(), marks, strict=True):
        trace = run.traces[name]
        heights = trace.link_pos[:, OBJECT, 2].astype(np.float64)
        ax.plot(trace.t, 1000 * (heights - heights[0]), label=label, **look(mark))
    for phase in ("settle", "close", "lift"):
        ax.axvline(trace.t[ENDS[phase]], **LINE)
    ax.set(xlabel="time [s]", ylabel="rise [mm]")
    plotting.label_ends(ax, "Height of the objects above their start")
    return figure
