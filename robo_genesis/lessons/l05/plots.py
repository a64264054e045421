"""Figures of L05's lecture and lab, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.plotting import look
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05 import spec
from robo_genesis.lessons.l05.checks import marker
from robo_genesis.lessons.l05.metrics import HAND
from robo_genesis.lessons.view_record import frame_names, view_of
from robo_genesis.sim import camera_geometry as cameras
from robo_genesis.sim.franka import LINK_PARENTS

AROUND = 45
"""Half the width of the shown part of the picture around the marker [pixel]."""


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured link origins."""
    if run.rendered:
        return plotting.both_ends(run.frames)
    figure = plotting.figure(5)
    plotting.schematic(figure.subplots(), run.traces["baseline"], LINK_PARENTS)
    return figure


def distance(run: Experiment) -> Figure:
    """Draw the distance of the hand from its target over time, on a logarithmic scale."""
    figure = plotting.figure(3.6)
    ax = figure.subplots()
    for name in spec.CASES:
        trace = run.traces[name]
        apart = np.linalg.norm(trace.link_pos[:, HAND] - spec.TARGET, axis=-1)
        style = look(spec.CASE_MARKS[name]) | {"linestyle": "-"}
        ax.semilogy(trace.t, 1000 * apart, label=spec.LABELS[name], **style)
    ax.set(xlabel="time [s]", ylabel="hand to target [mm]")
    plotting.legend_above(ax, "Distance of the hand from its target")
    return figure


def picture(run: Experiment) -> Figure:
    """Show the picture around the marker, with its centre as projected by hand."""
    view, sphere = view_of(run, spec.VIEWED), marker(run)
    u, v = cameras.project(sphere.centre, view.intrinsics, view.transform)
    figure = plotting.figure(plotting.WIDTH)
    ax = figure.subplots()
    if view.rgb is not None:
        height, width = view.rgb.shape[:2]
        shown = run.frames[frame_names(spec.VIEWED)[0]]
        ax.imshow(shown, extent=(0, width, height, 0), interpolation="nearest")
    cross = {"markersize": 16, "markeredgewidth": 2, "color": look("target")["color"]}
    ax.plot([u], [v], "+", label="projected by hand", **cross)
    ax.set(xlim=(u - AROUND, u + AROUND), ylim=(v + AROUND, v - AROUND), aspect="equal")
    ax.set(xlabel="u [pixel]", ylabel="v [pixel]")
    ax.grid(visible=False)
    plotting.legend_above(ax, "The marker in the picture")
    return figure
