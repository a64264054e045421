"""Figures of L01, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import look
from robo_genesis.sim.bodies.free_fall import predicted

from . import machine

MEASURES = False


def height(run: Experiment) -> Figure:
    """Draw the measured heights on the computed ones, and the height on the ground."""
    (figure, ax), case, trace = (
        plotting.axes(3.2),
        run.cases["baseline"],
        run.traces["baseline"],
    )
    computed = case.height - predicted(trace, case)
    ax.plot(trace.t, computed, label="computed beforehand", **look("target"))
    colour = look("baseline")["color"]
    ax.plot(trace.t, trace.link_pos[:, 0, 2], ".", label="measured", color=colour)
    ax.axhline(case.size / 2, label="centre of a sphere on the ground", **look("limit"))
    ax.set_ylim(bottom=0)
    plotting.finish(ax, "Height of the sphere's centre", "height z [m]", "center left")
    return figure


def ends(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the heights."""
    if not run.rendered:
        return height(run)
    return plotting.stacked({name: run.frames[name] for name in ("initial", "final")})


def starts(run: Experiment) -> Figure:
    """Draw the time of each part of both starts [s], in whole seconds beside the bars."""
    (figure, ax), found = plotting.axes(3.6), run.readings[machine.TIMES]
    for start, shift in zip(machine.STARTS, (-0.2, 0.2), strict=True):
        times = [found[f"{start}_{part}"] for part in machine.PARTS]
        times.append(sum(times))
        places, colour = np.arange(len(times)) + shift, look(start)["color"]
        bars = ax.barh(places, times, 0.38, color=colour, label=f"{start} start")
        ax.bar_label(bars, [f"{t:.0f}" if t > 0.5 else "< 1" for t in times], padding=3)
    ax.set_yticks(range(len(times)), [*machine.PARTS.values(), "together"])
    ax.invert_yaxis()
    ax.set_xlabel("time [s]")
    plotting.legend_above(ax, "Where the time of a start goes")
    return figure
