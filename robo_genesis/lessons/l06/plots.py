"""Figures of L06, each a function of the experiment."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, look
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.franka import LINK_PARENTS
from robo_genesis.sim.arm.kinematics import HAND

from . import spec
from .run import Environment
from .text import fits, steps
from .throughput import FITTED, GROUP

MEASURES = False


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the link origins of environment 0."""
    return plotting.robot_ends(run, LINK_PARENTS)


def to_target(run: Experiment, name: str, world: Environment) -> FloatArray:
    """Return the distance (n+1,) of the hand from the target that was commanded last [mm]."""
    trace = run.traces[name]
    target = np.repeat(world.positions[:1], trace.steps + 1, axis=0)
    target[world.switch + 1 :] = world.positions[-1]
    apart = np.linalg.norm(trace.link_pos[:, HAND].astype(float) - target, axis=1)
    return 1000 * apart


def distance(run: Experiment) -> Figure:
    """Draw the distance of each hand from its target, and the time of the second command."""
    figure, ax = plotting.axes(3.6)
    for name, world in spec.WORLDS.items():
        apart, style = to_target(run, name, world), look(spec.CASE_MARKS[name])
        ax.semilogy(run.traces[name].t, apart, label=spec.LABELS[name], **style)
    ax.set_xlabel("time [s]")
    title, ylabel = "Distance of each hand from its target", "hand to target [mm]"
    plotting.label_ends(ax, title, ylabel)
    ax.axvline(spec.SWITCH * spec.FIRST.dt, **LINE)
    return figure


THEORY = look("target", linestyle=(0, (4, 2)), linewidth=1.6)
MEASURED = look("first", marker="o", markersize=4)


def times(run: Experiment, name: str) -> FloatArray:
    """Return one kind of reading for each number of environments [s]."""
    return np.array([run.readings[GROUP][f"{name}_{size}"] for size in steps(run)])


def of_environments(ax: Axes, run: Experiment, title: str, ylabel: str) -> None:
    """Make both axes logarithmic and label them: numbers of environments to the right."""
    shown = [size for size in steps(run) if size.bit_count() == 1]  # powers of two
    plotting.log_axis(ax, shown, "number of environments B")
    ax.set(yscale="log", ylabel=ylabel)
    plotting.legend_above(ax, title)


def throughput(run: Experiment) -> Figure:
    """Draw the steps of all environments in a second, and proportional growth."""
    (figure, ax), numbers = plotting.axes(3.6), np.array([*steps(run)])
    step = times(run, "step")
    ax.plot(numbers, numbers / step[0], label="B times the first", **THEORY)
    ax.plot(numbers, numbers / step, label="measured", **MEASURED)
    slow, fast = (numbers / times(run, name) for name in ("slowest", "fastest"))
    ax.vlines(numbers, slow, fast, color=MEASURED["color"])
    of_environments(ax, run, "Throughput", "steps per second, all")
    ax.set_ylim(top=4 * (numbers / step).max())
    return figure


def model(run: Experiment) -> Figure:
    """Draw the measured time of a step, and the range of the models."""
    (figure, ax), numbers = plotting.axes(3.8), np.array([*steps(run)])
    step, known = 1000 * times(run, "step"), np.isin(numbers, FITTED)
    fine = np.geomspace(numbers[0], numbers[-1], 60)
    models = [1000 * one.step_time(fine) for one in fits(run)]
    band = {"color": THEORY["color"], "alpha": 0.3, "linewidth": 0, "label": "models"}
    ax.fill_between(fine, np.min(models, axis=0), np.max(models, axis=0), **band)
    dots = MEASURED | {"linestyle": "none", "markersize": 5}
    ax.plot(numbers[known], step[known], label="in the fits", **dots)
    ax.plot(numbers[~known], step[~known], label="predicted", fillstyle="none", **dots)
    of_environments(ax, run, "Time of a step", "one step [ms]")
    ax.yaxis.set_major_formatter(ScalarFormatter())
    return figure
