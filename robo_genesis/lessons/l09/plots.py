"""Figures of L09, each a function of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import look
from robo_genesis.sim.arm.franka import LINK_PARENTS

from . import spec
from .text import interval

MEASURES = False

SIGNS = "osD^vP"  # Of the kinds in one figure; there are as many colours


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the link origins of an episode."""
    return plotting.robot_ends(run, LINK_PARENTS)


def losses(run: Experiment, name: str) -> Figure:
    """Draw the loss of each network of a kind over the steps of the optimiser."""
    figure, ax = plotting.axes(3.2)
    trace = run.traces[name]
    for loss in 100 * trace.loss.T:
        ax.semilogy(trace.t[1:], loss, **look("baseline") | {"lw": 0.9})
    least = 100 * trace.loss.min()
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1, 2, 5, 10) if tick >= least]
    ax.set_yticks(ticks, map(str, ticks))
    ax.minorticks_off()
    ax.set(xlabel="step of the optimiser", ylabel="loss [%]")
    ax.set_title("The loss of eight networks")
    return figure


def orders(run: Experiment, *names: str) -> Figure:
    """Draw the rate of kinds of clones over their error, with intervals."""
    figure, ax = plotting.axes(4.4)
    for name, sign, mark in zip(names, SIGNS, plotting.CYCLE, strict=False):
        mean = run.traces[name].shares.mean()
        low, high = interval(run.traces[name])
        ends = [[max(mean - low, 0)], [max(high - mean, 0)]]
        x = 1000 * run.metrics[name].error
        style = {"color": look(mark)["color"], "label": spec.LABELS[name]}
        ax.errorbar(x, 100 * mean, 100 * np.array(ends), fmt=sign, capsize=3, **style)
    ax.set(
        xlabel="median error of a command [mrad]",
        ylabel="success [%]",
        ylim=(-4, 104),
        xlim=(0, None),
    )
    ax.set_title("Success over error", pad=8 + 15.5 * len(names))
    ax.legend(
        loc="lower left",
        bbox_to_anchor=(-0.02, 0.99),
        borderaxespad=0,
        labelspacing=0.2,
    )
    return figure


def networks(run: Experiment, *names: str) -> Figure:
    """Draw the rate of each network as a point, and the interval of their mean."""
    figure, ax = plotting.axes(0.8 + 0.6 * len(names))
    for row, name in enumerate(reversed(names)):
        shares = 100 * run.traces[name].shares
        ends = 100 * np.array(interval(run.traces[name]))
        spot = np.linspace(-0.12, 0.12, len(shares))
        ax.plot(np.sort(shares), row + spot, "o", ms=3, color=look("first")["color"])
        ax.plot(ends, [row + 0.28] * 2, **look("baseline"))
        ax.plot(
            [shares.mean()], [row + 0.28], "|", ms=8, color=look("baseline")["color"]
        )
        ax.text(0, row + 0.36, spec.LABELS[name], va="bottom")
    ax.set(
        xlabel="success [%]", xlim=(-3, 103), ylim=(-0.4, len(names) - 0.1), yticks=()
    )
    return figure
