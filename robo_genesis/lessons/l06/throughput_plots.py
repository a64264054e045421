"""Figures of L06 about throughput, each a function of the experiment."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator, ScalarFormatter

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import look
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l06.throughput import FITTED, GROUP
from robo_genesis.lessons.l06.throughput_text import fitted, sizes

MEASURES = False

THEORY = look("target", linestyle=(0, (4, 2)), linewidth=1.6)
MEASURED = look("first", linestyle="-", marker="o", markersize=4)


def times(run: Experiment, name: str) -> FloatArray:
    """Return one kind of reading for each number of environments [s]."""
    return np.array([run.readings[GROUP][f"{name}_{size}"] for size in sizes(run)])


def of_environments(ax: Axes, run: Experiment) -> None:
    """Label a logarithmic axis with the measured numbers of environments."""
    shown = [size for size in sizes(run) if size != 512]
    ax.set_xscale("log")
    ax.set_xticks(shown, [str(size) for size in shown])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.set_xlabel("number of environments B")


def throughput(run: Experiment) -> Figure:
    """Draw the steps of all environments in a second, and proportional growth."""
    figure, numbers = plotting.figure(3.6), np.array(sizes(run))
    ax, step = figure.subplots(), times(run, "step")
    ax.plot(numbers, numbers / step[0], label="B times the first", **THEORY)
    ax.plot(numbers, numbers / step, label="measured", **MEASURED)
    slow, fast = (numbers / times(run, name) for name in ("slowest", "fastest"))
    ax.vlines(numbers, slow, fast, color=MEASURED["color"])
    of_environments(ax, run)
    ax.set_yscale("log")
    ax.set_ylim(top=4 * (numbers / step).max())
    ax.set_ylabel("steps per second, all")
    plotting.legend_above(ax, "Throughput")
    return figure


def model(run: Experiment) -> Figure:
    """Draw the measured time of a step and the model."""
    figure, numbers = plotting.figure(3.8), np.array(sizes(run))
    ax, step, known = figure.subplots(), 1000 * times(run, "step"), np.isin(numbers, FITTED)
    fine = np.geomspace(numbers[0], numbers[-1], 60)
    ax.plot(fine, 1000 * fitted(run).step_time(fine), label="model", **THEORY)
    dots = MEASURED | {"linestyle": "none", "markersize": 5}
    ax.plot(numbers[known], step[known], label="fitted", **dots)
    ax.plot(numbers[~known], step[~known], label="predicted", fillstyle="none", **dots)
    of_environments(ax, run)
    ax.set_yscale("log")
    ax.yaxis.set_major_formatter(ScalarFormatter())
    ax.set_ylabel("one step [ms]")
    plotting.legend_above(ax, "Time of a step")
    return figure
