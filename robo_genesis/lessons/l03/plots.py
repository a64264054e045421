"""Figures of bodies that land, slide and bounce: functions of the experiment, and of axes."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, legend_above, look
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import checks, friction, spec
from robo_genesis.lessons.l03.energy import (
    clearance,
    conserved_energy,
    kept_at_bounces,
    total_energy,
)
from robo_genesis.sim.bodies.contacts import TOP, ContactCase

MEASURES = False

LANDING_MARKS = {
    "baseline": "baseline",
    "dt10_sub1": "first",
    "dt20_sub2": "third",
    "dt20_sub1": "second",
}
SAMPLE_MARKS = {"baseline": "o", "dt10_sub1": "o", "dt20_sub2": "s", "dt20_sub1": "^"}
"""Markers of the samples: two of these landings coincide."""

SLIDE_MARKS = {
    "low_on_050": "first",
    "high_on_050": "second",
    "low_on_030": "third",
    "high_on_030": "other",
}
EQUAL_BELOW = {"linewidth": 4.0, "alpha": 0.45}
"""Style of a curve that lies below an equal one."""

BOUNCES_SHOWN = ("bounce_sub1", "bounce_sub2", "bounce_sub100")
WINDOW = (0.18, 0.44)
"""Around the landing of the lab [s]."""

OPEN_MARKERS = ("dt20_sub2",)
"""Markers through which the curve of another run stays visible."""

Cases = Mapping[str, ContactCase]
Traces = Mapping[str, ContactTrace]


def solid(mark: str, **more: Any) -> dict[str, Any]:
    """Return the line style of measured data: the colour of a mark, without its dashes."""
    return look(mark) | {"linestyle": "-"} | more


def legend_below(figure: Figure) -> None:
    """Put the legend of the first axes below a figure, one line for each curve."""
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower left")


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured positions."""
    if run.rendered:
        return plotting.both_ends(run.frames)
    figure = plotting.figure(5)
    plotting.body_schematic(figure.subplots(), run.traces["baseline"], spec.BASELINE.size, TOP)
    return figure


def landings(run: Experiment) -> Figure:
    """Draw the clearance below the cubes of the lab around their landing."""
    figure = plotting.figure(4.6)
    heights(figure.subplots(), run.traces, spec.LANDINGS, WINDOW)
    legend_below(figure)
    return figure


def contact_counts(run: Experiment) -> Figure:
    """Draw the number of contact points of the lab's cubes around their landing."""
    figure = plotting.figure(4)
    counted(figure.subplots(4, 1, sharex=True, sharey=True), run.traces, WINDOW)
    return figure


def pushed(run: Experiment) -> Figure:
    """Draw speed, clearance and angular speed of the lab's pushed cubes."""
    figure = plotting.figure(7)
    axes = figure.subplots(3, 1, sharex=True)
    slides(axes, run.traces, spec.SLIDES, SLIDE_MARKS, spec.LABELS, below="high_on_050")
    legend_below(figure)
    return figure


def stopping_distances(run: Experiment) -> Figure:
    """Draw the stopping distances of the lab's cubes beside Coulomb's."""
    coulomb = {
        name: friction.coulomb_distance(case.speed, friction.pair_friction(case))
        for name, case in spec.SLIDES.items()
    }
    figure = plotting.figure(3.2)
    found = {name: of.stop_distance for name, of in checks.slides(run).items()}
    stopping(figure.subplots(), found, coulomb)
    return figure


def ball_energies(run: Experiment) -> Figure:
    """Draw both energies of the ball for three of the solver steps."""
    figure = plotting.figure(6)
    shown = {name: spec.BOUNCES[name] for name in BOUNCES_SHOWN}
    energies(figure.subplots(2, 1, sharex=True), run.traces, shown)
    return figure


def kept_by_step(run: Experiment) -> Figure:
    """Draw the energy that the ball keeps at its first bounce by solver step."""
    figure = plotting.figure(3.2)
    shares = {spec.BOUNCES[name].h: of.first_kept for name, of in checks.bounces(run).items()}
    assert spec.DROPPED_BALL.spring is not None
    kept(figure.subplots(), shares, 100 * kept_at_bounces(spec.DROPPED_BALL.spring[1]))
    return figure


def heights(
    ax: Axes,
    traces: Traces,
    cases: Cases,
    window: tuple[float, float],
    marks: Mapping[str, str] = LANDING_MARKS,
) -> Axes:
    """Draw the clearance below each dropped cube at every sample, zero at the surface.

    Args:
        ax: where to draw.
        traces: by case.
        cases: by name; each case of `marks` is drawn.
        window: start and end of the time axis [s].
        marks: of the palette, by case.
    """
    for name, mark in marks.items():
        clear = 1000 * clearance(traces[name], cases[name])
        style = solid(mark, marker=SAMPLE_MARKS.get(name, "."), markersize=3)
        if name in OPEN_MARKERS:
            style |= {"markersize": 7, "markerfacecolor": "none", "linewidth": 0.8}
        label = f"{spec.LABELS[name]}, h = {1000 * cases[name].h:g} ms"
        ax.plot(traces[name].t, clear, label=label, **style)
    ax.axhline(0, **LINE)
    ax.set(xlim=window, ylim=(-26, 32), xlabel="time [s]", ylabel="clearance [mm]")
    ax.set_title("Below zero, the cube is in the table", loc="left")
    return ax


def counted(axes: Sequence[Axes], traces: Traces, window: tuple[float, float]) -> None:
    """Draw the number of reported contact points at each sample, one dropped cube in each axes.

    A triangle marks the deepest sample of each cube.
    """
    for ax, (name, mark) in zip(axes, LANDING_MARKS.items(), strict=True):
        t, counts = traces[name].t, traces[name].contacts[:, 0]
        deepest = int(clearance(traces[name], spec.LANDINGS[name]).argmin())
        ax.step(t, counts, where="post", **solid(mark))
        ax.plot(t[deepest], counts[deepest], marker="v", **solid(mark, markersize=8))
        ax.set(xlim=window, yticks=[0, 4], ylim=(-0.5, 4.8))
        ax.set_title(f"{spec.LABELS[name]} (triangle: deepest sample)", loc="left")
    axes[-1].set_xlabel("time [s]")


def slides(
    axes: Sequence[Axes],
    traces: Traces,
    cases: Cases,
    marks: Mapping[str, str],
    labels: Mapping[str, str],
    below: str = "",
) -> None:
    """Draw speed along x, clearance and angular speed of each pushed cube.

    Args:
        axes: three, one below another.
        traces: by case.
        cases: the cases to draw.
        marks: of the palette, by case.
        labels: by case; the caller puts the legend.
        below: a case whose curves are equal to later ones and are drawn wider below them.
    """
    for name, case in cases.items():
        trace, style = traces[name], solid(marks[name], **EQUAL_BELOW if name == below else {})
        axes[0].plot(trace.t, trace.link_vel[:, 0, 0], label=labels[name], **style)
        axes[1].plot(trace.t, 1000 * clearance(trace, case), **style)
        axes[2].plot(trace.t, trace.link_ang[:, 0, 1], **style)
    heads = ("speed along x [m/s]", "clearance [mm]", "turning about y [rad/s]")
    for ax, head in zip(axes, heads, strict=True):
        ax.set_ylabel(head)
        ax.axhline(0, **LINE)
        ax.set_xlim(0, 0.9)
    axes[2].set_xlabel("time after the push [s]")


def stopping(ax: Axes, distances: Mapping[str, float | None], formula: Mapping[str, float]) -> Axes:
    """Draw stopping distances as bars, each with Coulomb's distance as a mark [m]."""
    for place, (name, length) in enumerate(distances.items()):
        if length is not None:
            ax.barh(place, length, height=0.55, color=look(SLIDE_MARKS[name])["color"])
        ax.plot([formula[name]] * 2, [place - 0.4, place + 0.4], **look("target"))
    words = [spec.LABELS[name].replace(" on ", "\non ") for name in distances]
    ax.set_yticks(range(len(distances)), words)
    ax.invert_yaxis()
    ax.set_xlabel("distance [m]")
    ax.set_title("Bars: measured. Dotted marks: v² / (2 μ g)", loc="left")
    return ax


def energies(axes: Sequence[Axes], traces: Traces, cases: Cases) -> None:
    """Draw the total energy of bouncing balls in the air, and the energy that the steps conserve.

    Args:
        axes: two, one below another.
        traces: by case.
        cases: up to three cases to draw.
    """
    for (name, case), mark in zip(cases.items(), ("second", "other", "third"), strict=False):
        trace = traces[name]
        start, clear = total_energy(trace, case)[0], clearance(trace, case) > 0
        for ax, energy in zip(axes, (total_energy, conserved_energy), strict=True):
            share = np.where(clear, 100 * energy(trace, case) / start, np.nan)
            label = f"h = {1000 * case.h:g} ms"
            ax.plot(trace.t, share, label=label, **solid(mark, linewidth=1.5))
    axes[0].set_title("Total energy", loc="left")
    axes[1].set_title("Total energy − m g h v / 2", loc="left")
    for ax in axes:
        ax.set(ylabel="share of the start [%]", ylim=(50, 108))
    axes[1].set_xlabel("time [s]")
    axes[1].legend(loc="lower left")


def kept(ax: Axes, shares: Mapping[float, float | None], expected: float) -> Axes:
    """Draw the share of the energy that is kept at the first bounce by solver step.

    Args:
        ax: where to draw.
        shares: by solver step [s], in percent.
        expected: the share that a linear spring with the same damping keeps [%].
    """
    h = [1000 * step for step in shares]
    ax.semilogx(h, list(shares.values()), marker="o", label="measured", **look("baseline"))
    ax.axhline(expected, label="linear spring", **look("target"))
    ax.axhline(100, label="no loss", **LINE)
    ax.set_xticks(h, [f"{step:g}" for step in h])
    ax.minorticks_off()
    ax.set(xlabel="solver step h [ms]", ylabel="kept at the first bounce [%]")
    legend_above(ax, "")
    return ax
