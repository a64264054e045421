"""Figures of the course. Functions draw on axes; none computes or shows.

Each figure has the width `WIDTH` and letters of one size, so that it can be read on a
phone. Panels lie one below another. Colours are those of the light theme; pages replace
them by the reader's theme, so a figure has no colours but the palette's.
"""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.rcsetup import cycler

from .channels import Channel, Level
from .experiment import Experiment
from .palette import MARKS, PARTS, marks_of
from .scene import FloatArray
from .trace import BodyTrace, Trace

MEASURES = False

WIDTH = 4.25  # Of each figure [inch]: about the width of a phone's page

# A thin solid line for a target or for zero.
LINE: dict[str, Any] = {"color": PARTS["line"].light, "linewidth": 0.9, "zorder": 1}

# The marks of lines that name none, in their order.
CYCLE = ("first", "second", "third", "other", "further", "baseline")

BAND = PARTS["band"].light

# Smallest distance of the labels beside the ends of lines, as a share of the axes'
# height.
LABELS_APART = 0.09


def figure(height: float) -> Figure:
    """Return an empty figure of the course's width; `height` [inch]."""
    return Figure(figsize=(WIDTH, height))


def axes(height: float) -> tuple[Figure, Axes]:
    """Return a figure of the course's width with one pair of axes; `height` [inch]."""
    drawn = figure(height)
    return drawn, drawn.subplots()


def look(name: str, **more: Any) -> dict[str, Any]:
    """Return the line style of a mark of the palette in the light theme."""
    mark = MARKS[name]
    return {
        "color": mark.light,
        "linestyle": (0, mark.dashes) if mark.dashes else "-",
        **more,
    }


LIMIT = look("limit", linewidth=1.4)


def use_course_style() -> None:
    """Set fonts, grid and sizes; notebooks embed figures as SVG, the same bytes each run."""
    text, line = PARTS["text"].light, PARTS["line"].light
    mpl.rcParams.update(
        {
            "axes.edgecolor": line,
            "axes.grid": True,
            "axes.labelcolor": text,
            "axes.prop_cycle": cycler("color", [MARKS[name].light for name in CYCLE]),
            "axes.spines.right": False,
            "axes.spines.top": False,
            "axes.titlelocation": "left",
            "axes.titlesize": "medium",
            "figure.constrained_layout.use": True,
            "figure.facecolor": PARTS["ground"].light,
            "font.size": 10.5,
            "grid.color": PARTS["grid"].light,
            "image.interpolation": "none",
            "hatch.color": text,
            "legend.fontsize": "medium",
            "legend.frameon": False,
            "lines.linewidth": 1.7,
            "patch.edgecolor": text,
            "svg.fonttype": "path",
            "svg.hashsalt": "robo-genesis",
            "text.color": text,
            "xtick.color": line,
            "xtick.labelcolor": text,
            "ytick.color": line,
            "ytick.labelcolor": text,
        }
    )
    interactive = sys.modules.get("IPython")
    if interactive is None or interactive.get_ipython() is None:  # not in a notebook
        return
    from matplotlib_inline.backend_inline import set_matplotlib_formats

    set_matplotlib_formats("svg", metadata={"Date": None, "Creator": None})


@contextmanager
def course_style() -> Iterator[None]:
    """Draw in the course's style, independent of a user's Matplotlib settings, and restore them."""
    with mpl.rc_context():
        mpl.rcdefaults()
        use_course_style()
        yield


def channel(
    ax: Axes,
    t: FloatArray,
    drawn: Channel,
    subject: str,
    marks: Mapping[str, str],
    levels: Sequence[Level] = (),
) -> None:
    """Draw one channel of each case with its levels.

    Args:
        ax: where to draw.
        t: times of the states (n+1,) [s].
        drawn: the channel.
        subject: the joint or body that it belongs to.
        marks: the declared marks of cases by name.
        levels: of this channel; equal ones of several cases are drawn once.
    """
    for level in levels:
        values = dict.fromkeys(
            value for case in level.values.values() for value in case
        )
        for number, value in enumerate(values):
            if level.band:
                label = "" if number else f"band ±{level.band:g} {drawn.unit}"
                edges = value - level.band, value + level.band
                ax.axhspan(*edges, color=BAND, zorder=0, label=label)
            name = "" if number else level.name
            ax.axhline(value, **look(level.mark, label=name, linewidth=1.4))
    for case, mark in marks_of(drawn.values, marks).items():
        ax.plot(t, drawn.values[case], label=case, **look(mark))
    ax.margins(x=0.01)
    ax.set_ylim(top=drawn.top)
    finish(
        ax, f"{drawn.name.capitalize()} of {subject}", f"{drawn.head} [{drawn.unit}]"
    )


def stacked(pictures: Mapping[str, np.ndarray]) -> Figure:
    """Show camera frames one below the other, each with its name on a ground of its own."""
    plate = {"facecolor": "black", "alpha": 0.7, "linewidth": 0}
    height = 1.02 * sum(
        picture.shape[0] / picture.shape[1] for picture in pictures.values()
    )
    drawn = Figure(figsize=(WIDTH, height * WIDTH), facecolor="none")
    drawn.set_layout_engine("none")
    places = {"left": 0, "right": 1, "bottom": 0, "top": 1, "hspace": 0.04}
    axes = drawn.subplots(len(pictures), 1, squeeze=False, gridspec_kw=places)[:, 0]
    for ax, (name, picture) in zip(axes, pictures.items(), strict=True):
        ax.imshow(picture)
        ax.set_axis_off()
        ax.text(
            0.03,
            0.94,
            f"Camera frame, {name}",
            transform=ax.transAxes,
            va="top",
            color="white",
            bbox=plate,
        )
    return drawn


def ends(
    frames: Mapping[str, np.ndarray], height: float, draw: Callable[[Axes], object]
) -> Figure:
    """Show the camera frames of both ends of a run, or what is drawn without frames.

    Args:
        frames: with `initial` and `final`; none without a camera.
        height: of the drawing [inch].
        draw: draws a schematic.
    """
    if frames:
        return stacked({name: frames[name] for name in ("initial", "final")})
    drawn, ax = axes(height)
    draw(ax)
    return drawn


def robot_ends(run: Experiment, parents: Sequence[int]) -> Figure:
    """Show both ends of a page's first run, without a camera its links as `schematic` does."""
    trace = run.traces[next(iter(run.cases))]
    return ends(run.frames, 5, lambda ax: schematic(ax, trace, parents))


def schematic(ax: Axes, trace: Trace, parents: Sequence[int]) -> None:
    """Draw the measured link origins at both ends as a stick figure seen from the side.

    Args:
        ax: where to draw.
        trace: its first and last link positions are drawn, x against z [m].
        parents: for each link the local index of its parent, -1 for the base.
    """
    ends = {"before the first step": 0, "after the last step": -1}
    bones = {
        label: [
            trace.link_pos[when][[parent, link]][:, [0, 2]]
            for link, parent in enumerate(parents)
            if parent >= 0
        ]
        for label, when in ends.items()
    }
    _from_the_side(ax, "link origins", bones, marker="o", markersize=4)


def body_schematic(ax: Axes, trace: BodyTrace, size: float, floor: float = 0.0) -> None:
    """Draw a cube in its first and last state as a square seen from the side, x against z [m].

    Args:
        ax: where to draw.
        trace: the run.
        size: edge of the cube [m].
        floor: height of the surface below it [m].
    """
    corners = size / 2 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])
    ends = {"start": 0, "end": -1}
    squares = {
        label: [trace.link_pos[k, 0, [0, 2]] + corners] for label, k in ends.items()
    }
    ax.axhline(floor, **LINE)
    _from_the_side(ax, "positions", squares)


def _from_the_side(
    ax: Axes, what: str, ends: Mapping[str, Sequence[np.ndarray]], **more: Any
) -> None:
    """Draw lines (n, 2) of both ends of a run by label, x against z [m]."""
    for (label, lines), name in zip(ends.items(), ("other", "baseline"), strict=True):
        for number, line in enumerate(lines):
            ax.plot(*line.T, label="" if number else label, **look(name, **more))
    title = f"Schematic of measured {what}:\nthis is not a camera frame"
    ax.set(aspect="equal", xlabel="x [m]", ylabel="z [m]")
    ax.set_title(title, loc="center")
    ax.legend()


def finish(ax: Axes, title: str, ylabel: str, legend: str = "above") -> None:
    """Label a plot over time; the legend is `above` it or at a place that Matplotlib names."""
    ax.set(xlabel="time [s]", ylabel=ylabel)
    if legend == "above":
        legend_above(ax, title)
    else:
        ax.set_title(title)
        ax.legend(loc=legend)  # type: ignore[call-overload]


def legend_above(ax: Axes, title: str) -> None:
    """Put the legend above the axes, in two columns, and the title above it."""
    rows = -(-len(ax.get_legend_handles_labels()[1]) // 2)
    ax.set_title(title, pad=8 + 15.5 * rows)
    ax.legend(
        loc="lower left",
        bbox_to_anchor=(-0.02, 0.99),
        borderaxespad=0,
        labelspacing=0.2,
        columnspacing=1.2,
        ncols=2,
    )


def log_axis(ax: Axes, ticks: Iterable[float], label: str) -> None:
    """Make the horizontal axis logarithmic, with ticks at some values alone, and name it."""
    shown = sorted(set(ticks))
    ax.set_xscale("log")
    ax.set_xticks(shown, [f"{tick:g}" for tick in shown])
    ax.minorticks_off()
    ax.set_xlabel(label)


def label_ends(ax: Axes, title: str, ylabel: str) -> None:
    """Write the label of each line beside its last point, in its colour; labels keep a distance.

    Call it when all lines are drawn: it fixes the vertical range.
    """
    ax.set(title=title, ylabel=ylabel, ylim=ax.get_ylim())
    lines = [
        line for line in ax.get_lines() if not str(line.get_label()).startswith("_")
    ]
    places = ax.transData + ax.transAxes.inverted()
    ends = [places.transform(line.get_xydata()[-1])[1] for line in lines]  # type: ignore[index]
    order = np.argsort(ends, kind="stable")
    apart = np.arange(len(lines)) * LABELS_APART
    heights = np.maximum.accumulate(np.array(ends)[order] - apart) + apart
    heights += np.mean(ends) - np.mean(heights)
    heights += np.clip(0.0, 0.04 - heights[0], 0.96 - heights[-1])
    for k, height in zip(order, heights, strict=True):
        ax.annotate(
            str(lines[k].get_label()),
            (1.01, height),
            xycoords="axes fraction",
            va="center",
            color=lines[k].get_color(),
            annotation_clip=False,
        )
