"""Figures of L07, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import BAND, LINE, legend_above, look
from robo_genesis.sim.arm.franka import LINK_PARENTS
from robo_genesis.sim.arm.lifting import ENDS
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.bowl import CHOICES
from robo_genesis.sim.bodies.soft_contact import depth_and_creep

from . import bowls, rungs, spec
from .metrics import OBJECT

MEASURES = False

# Mark in the palette and words of the boxes that differ in friction.
FRICTIONS = {
    "box": ("first", "μ = 0.5"),
    "firm": ("second", "μ = 1"),
    "rough": ("third", "μ = 2"),
}


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the link origins of scene A."""
    return plotting.robot_ends(run, LINK_PARENTS)


def views(run: Experiment) -> Figure:
    """Show what both cameras see of scene A, without a camera its link origins."""
    if not run.rendered:
        return posture(run)
    return plotting.stacked(
        {place: run.frames[f"{name}_rgb"] for name, place in rungs.CAMERAS.items()}
    )


def lifts(run: Experiment) -> Figure:
    """Draw the heights of the objects, relative to those at the end of closing."""
    figure, ax = plotting.axes(3.6)
    for name, label in spec.SHOWN_LIFTS.items():
        trace = run.traces[name]
        height = 1000 * trace.link_pos[:, OBJECT, 2]
        rise = height - height[ENDS["close"]]
        ax.plot(trace.t, rise, label=label, **look(spec.CASE_MARKS.get(name, "other")))
    for phase, begins in (("settle", "close"), ("close", "lift"), ("lift", "hold")):
        at = trace.t[ENDS[phase]]
        ax.axvline(at, **LINE)
        ax.annotate(f" {begins}", (at, 25))
    ax.set_xlim(trace.t[ENDS["descend"]], trace.t[-1])
    plotting.finish(ax, "Height relative to the end of closing", "rise [mm]")
    return figure


def bowl_section(run: Experiment) -> Figure:
    """Draw the top of the collision geometry over the bowl's wall, cut at y = 0, by choice."""
    figure = plotting.figure(3.8)
    axes = figure.subplots(len(bowls.CUT), 1, sharex=True, sharey=True)
    outer, inner = (
        1000 * of * (np.cos(np.pi / bowl.SECTIONS), 1) for of in bowl.profiles()
    )
    half = np.vstack([outer, inner[::-1]])
    wall = np.vstack([half, half[::-1] * (-1, 1)])
    for ax, choice in zip(axes, bowls.CUT, strict=True):
        ax.fill(*wall.T, color=BAND, label="the mesh")
        ax.plot(*wall.T, **LINE)
        tops = 1000 * np.array([*run.readings[f"top_{choice}"].values()])
        ax.plot(
            1000 * bowls.ACROSS,
            tops,
            label="top of the collision geometry",
            **look("second"),
        )
        ax.set(aspect="equal", ylabel="z [mm]", ylim=(-3, 56), yticks=[0, 25, 50])
        ax.set_title(CHOICES[choice].capitalize())
    axes[-1].set_xlabel("x [mm]")
    figure.legend(
        *axes[0].get_legend_handles_labels(), loc="outside lower left", ncols=2
    )
    return figure


def creep_by_tilt(run: Experiment) -> Figure:
    """Draw the creep over the tilt by coefficient: measured as points, the formula dotted."""
    figure, ax = plotting.axes(4.0)
    for box, (mark, label) in FRICTIONS.items():
        names = [f"tilt_{tilt}_{box}" for tilt in (0, 5, 10, 15, 20)]
        tilts = np.degrees([run.cases[name].tilt for name in names])
        colour = look(mark)["color"]
        ax.plot(
            tilts,
            [1000 * run.metrics[n].creep for n in names],
            "o",
            color=colour,
            label=label,
        )
        ax.plot(
            tilts,
            [1000 * depth_and_creep(run.cases[n])[1] for n in names],
            ":",
            color=colour,
        )
    ax.set(xlabel="tilt [°]", ylabel="creep [mm/s]", ylim=(0, None))
    legend_above(ax, "Dotted: formula")
    return figure
