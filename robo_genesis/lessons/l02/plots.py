"""Figures of a dropped box, each a function of the experiment."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import body_schematic, look
from robo_genesis.sim.bodies.free_fall import continuous_drop, fallen, predicted

from . import spec, trials

MEASURES = False


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured positions."""
    case, trace = run.cases["baseline"], run.traces["baseline"]
    return plotting.ends(
        run.frames, 4.5, lambda ax: body_schematic(ax, trace, case.size)
    )


def trays(run: Experiment) -> Figure:
    """Show the camera frame of both trays, without a camera the heights of both balls."""
    if run.rendered:
        return plotting.stacked({spec.TRAYS: run.frames[spec.TRAYS]})
    figure, ax = plotting.axes(2.6)
    found = run.readings[trials.TRAYS]
    ax.bar(
        list(found), list(found.values()), color=look("baseline")["color"], width=0.4
    )
    ax.axhline(spec.RIM, **plotting.LINE)
    ax.set(ylabel="height of the ball [m]")
    ax.set_title("Measured heights; the line is the rim:\nthis is not a camera frame")
    return figure


def height(run: Experiment) -> Figure:
    """Draw the height of the box's centre at every sample, and its height on the ground."""
    figure = plotting.figure(3.2)
    draw_height(figure.subplots(), run)
    return figure


def height_and_speed(run: Experiment) -> Figure:
    """Draw height and speed of the box at every sample, one above the other."""
    figure = plotting.figure(5.6)
    above, below = figure.subplots(2, 1, sharex=True)
    draw_height(above, run)
    draw_speed(below, run)
    above.label_outer()
    return figure


def draw_height(ax: Axes, run: Experiment) -> None:
    """Draw the height over time on given axes."""
    trace, case = run.traces["baseline"], run.cases["baseline"]
    ax.plot(
        trace.t,
        trace.link_pos[:, 0, 2],
        marker=".",
        label="measured, get_links_pos",
        **look("baseline"),
    )
    ax.axhline(case.size / 2, label="centre of a box on the ground", **look("limit"))
    ax.set_ylim(bottom=0)
    plotting.finish(ax, "Height of the box", "height z [m]", "center left")


def draw_speed(ax: Axes, run: Experiment) -> None:
    """Draw the speed downwards on given axes, beside g t."""
    trace, case = run.traces["baseline"], run.cases["baseline"]
    ax.plot(
        trace.t,
        -trace.link_vel[:, 0, 2],
        marker=".",
        label="measured, get_links_vel",
        **look("baseline"),
    )
    ax.plot(trace.t, case.gravity * trace.t, label="g t", **look("target"))
    plotting.finish(ax, "Speed of the box", "speed downwards [m/s]", "upper left")


def three_drops(run: Experiment) -> Figure:
    """Draw how much farther than g t² / 2 the box is, measured and by the stepped formula.

    The differences are a small part of the fall, so three curves of height would
    coincide.
    """
    trace, case = run.traces["baseline"], run.cases["baseline"]
    continuous = continuous_drop(trace.t, case.gravity)
    stepped = predicted(trace, case)
    figure, ax = plotting.axes(3.2)
    ax.axhline(0, label="continuous: g t² / 2", **plotting.LINE)
    ax.plot(
        trace.t,
        1000 * (stepped - continuous),
        label="stepped: g h² n (n + 1) / 2",
        **look("target"),
    )
    ax.plot(
        trace.t,
        1000 * (fallen(trace) - continuous),
        "o",
        markersize=4.5,
        label="measured",
        color=look("baseline")["color"],
    )
    plotting.finish(
        ax, "Against continuous free fall", "farther down [mm]", "upper left"
    )
    return figure
