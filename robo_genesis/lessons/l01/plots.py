"""Figures of L01, each a function of the experiment."""

from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import look
from robo_genesis.sim.bodies.free_fall import summed_drop

MEASURES = False


def height(run: Experiment) -> Figure:
    """Draw the measured heights on the computed ones, and the height on the ground."""
    (figure, ax), case, trace = plotting.axes(3.2), run.cases["baseline"], run.traces["baseline"]
    solver_steps = [case.substeps * k for k in range(trace.steps + 1)]
    computed = case.height - summed_drop(case.h, solver_steps, case.gravity)
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
