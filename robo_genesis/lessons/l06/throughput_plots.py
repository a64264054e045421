"""Figures of L06 about throughput, each a function of the experiment."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator, ScalarFormatter

from robo_genesis.core import plotting
from robo_genesis.core.plotting import look
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06.throughput import FITTED, GROUP, column, sizes_of
from robo_genesis.lessons.l06.throughput_text import fitted

THEORY = look("target", linestyle=(0, (4, 2)), linewidth=1.6)
MEASURED = look("first", linestyle="-", marker="o", markersize=4)


def of_environments(ax: Axes, sizes: list[int]) -> None:
    """Label a logarithmic axis with the measured numbers of environments."""
    ax.set_xscale("log")
    shown = [size for size in sizes if size != 512]
    ax.set_xticks(shown, [str(size) for size in shown])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.set_xlabel("number of environments B")


def throughput(run: Experiment) -> Figure:
    """Draw the steps of all environments in a second, and proportional growth."""
    figure, found = plotting.figure(3.6), run.readings[GROUP]
    ax, sizes = figure.subplots(), sizes_of(found)
    numbers, step = np.array(sizes), column(found, "step")
    rate = numbers / step
    ends = [numbers / column(found, name) for name in ("slowest", "fastest")]
    ax.plot(numbers, numbers / step[0], label="B times the first", **THEORY)
    ax.plot(numbers, rate, label="measured", **MEASURED)
    ax.vlines(numbers, *ends, color=MEASURED["color"])
    of_environments(ax, sizes)
    ax.set_yscale("log")
    ax.set_ylim(top=4 * rate.max())
    ax.set_ylabel("steps per second, all")
    plotting.legend_above(ax, "Throughput")
    return figure


def model(run: Experiment) -> Figure:
    """Draw the measured time of a step over the model, and their ratio below."""
    figure, found, of = plotting.figure(5.2), run.readings[GROUP], fitted(run)
    above, below = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": (2, 1)})
    sizes, step = sizes_of(found), 1000 * column(found, "step")
    numbers, expected = np.array(sizes), 1000 * of.step_time(np.array(sizes))
    fine = np.geomspace(sizes[0], sizes[-1], 60)
    above.plot(fine, 1000 * of.step_time(fine), label="model", **THEORY)
    known = np.isin(numbers, FITTED)
    dots = MEASURED | {"linestyle": "none"}
    above.plot(numbers[known], step[known], label="measured, fitted", **dots)
    above.plot(numbers[~known], step[~known], label="measured, predicted",
               **(dots | {"fillstyle": "none"}))  # fmt: skip
    above.set_yscale("log")
    above.yaxis.set_major_formatter(ScalarFormatter())
    above.set_ylabel("one step [ms]")
    plotting.legend_above(above, "Time of a step")
    below.axhline(1, **THEORY)
    below.plot(numbers, step / expected, **MEASURED)
    below.set_ylabel("measured / model")
    of_environments(below, sizes)
    return figure
