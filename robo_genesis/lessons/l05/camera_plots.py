"""Camera frames of the page about cameras."""

from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.lessons.experiment import Experiment


def picture(run: Experiment, view: str) -> Figure:
    """Show the colours of a recorded view, or SKIP without a camera."""
    figure = plotting.figure(0.75 * plotting.WIDTH if run.rendered else 0.5)
    figure.set_layout_engine("none")
    ax = figure.add_axes((0, 0, 1, 1))
    if run.rendered:
        plotting.frames([ax], {view: run.frames[f"{view}_rgb"]})
    else:
        ax.set_axis_off()
        ax.text(0, 0.5, "SKIP: this run has no camera.")
    return figure
