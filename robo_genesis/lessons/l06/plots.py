"""Figures of a box that lands, each a function of the experiment."""

from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.lessons.experiment import Experiment


def height(run: Experiment) -> Figure:
    """Draw the height of the box's centre at every sample."""
    figure, trace = plotting.figure(3.2), run.traces["baseline"]
    ax = figure.subplots()
    ax.plot(trace.t, trace.link_pos[:, 0, 2], label="centre")
    plotting.finish(ax, "Height of the box", "height z [m]", "best")
    return figure
