"""Figures of L05, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.franka import LINK_PARENTS
from robo_genesis.sim.arm.kinematics import HAND
from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera.record import view_of

from . import spec
from .checks import marker

MEASURES = False

AROUND = 45  # Half the width of the shown part of the picture around the marker [pixel]


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured link origins."""
    return plotting.robot_ends(run, LINK_PARENTS)


def distance(run: Experiment) -> Figure:
    """Draw the distance of the hand from its target over time, on a logarithmic scale."""
    figure, ax = plotting.axes(3.6)
    for name in spec.CASES:
        trace = run.traces[name]
        apart = np.linalg.norm(trace.link_pos[:, HAND] - spec.TARGET, axis=-1)
        style = plotting.look(spec.CASE_MARKS[name])
        ax.semilogy(trace.t, 1000 * apart, label=spec.LABELS[name], **style)
    plotting.finish(ax, "Distance of the hand from its target", "hand to target [mm]")
    return figure


def picture(run: Experiment) -> Figure:
    """Show the picture around the marker, with its centre as projected by hand."""
    view, sphere = view_of(run, spec.VIEWED), marker(run)
    u, v = cameras.project(sphere.centre, view.intrinsics, view.transform)
    figure, ax = plotting.axes(plotting.WIDTH)
    if view.rgb is not None:
        ax.imshow(view.rgb, extent=(0, *view.size, 0), interpolation="nearest")
    cross = {
        "markersize": 16,
        "markeredgewidth": 2,
        "color": plotting.look("target")["color"],
    }
    ax.plot([u], [v], "+", label="projected by hand", **cross)
    ax.set(xlim=(u - AROUND, u + AROUND), ylim=(v + AROUND, v - AROUND), aspect="equal")
    ax.set(xlabel="u [pixel]", ylabel="v [pixel]")
    ax.grid(visible=False)
    plotting.legend_above(ax, "The marker in the picture")
    return figure
