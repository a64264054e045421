"""Figures of landings, slides and bounces: functions of the experiment."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import (
    LINE,
    body_schematic,
    legend_above,
    log_axis,
    look,
)
from robo_genesis.sim.bodies.contacts import TOP

from . import checks, metrics, spec, study, study_spec, theory

MEASURES = False

# By run, the style of its line and the line's label in the legend.
Styles = dict[str, dict[str, Any]]


def styles(**marks: str) -> Styles:
    """Return the styles of runs with their marks of the palette."""
    return {name: look(mark, label=spec.LABELS[name]) for name, mark in marks.items()}


LANDINGS = styles(
    baseline="baseline", dt10_sub1="first", dt20_sub2="third", dt20_sub1="second"
)

# Markers of the samples: two landings coincide, and one stays visible through the
# other's.
SAMPLES: Styles = {name: {"marker": "o", "markersize": 3} for name in LANDINGS} | {
    "dt20_sub2": {
        "marker": "s",
        "markersize": 7,
        "markerfacecolor": "none",
        "linewidth": 0.8,
    },
    "dt20_sub1": {"marker": "^", "markersize": 3},
}

SLIDES = styles(
    low_on_050="first", high_on_050="second", low_on_030="third", high_on_030="other"
)
BOUNCES = styles(bounce_sub1="second", bounce_sub2="other", bounce_sub100="third")
WINDOW = (0.18, 0.44)  # Around the landing of the lab [s]
STEP_LABEL = "solver step h [ms]"

# Marks of the palette by scene; the landing from the baseline's height is drawn.
STEP_MARKS = {
    "h_20000us": "second",
    "h_10000us": "third",
    "h_5000us": "baseline",
    "h_125us": "first",
}


def legend_below(figure: Figure) -> None:
    """Put the legend of the first axes below a figure, one line for each curve."""
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower left")


def posture(run: Experiment) -> Figure:
    """Show the camera frames of both ends, without a camera the measured positions."""
    trace, size = run.traces["baseline"], spec.BASELINE.size
    return plotting.ends(run.frames, 5, lambda ax: body_schematic(ax, trace, size, TOP))


def landings(run: Experiment) -> Figure:
    """Draw the clearance below each dropped cube at every sample, zero at the surface."""
    figure, ax = plotting.axes(4.6)
    for name, style in LANDINGS.items():
        clear = 1000 * metrics.clearance(run.traces[name], run.cases[name])
        ax.plot(run.traces[name].t, clear, **style, **SAMPLES[name])
    ax.axhline(0, **LINE)
    ax.set(
        xlim=WINDOW,
        ylim=(-26, 32),
        xlabel="time [s]",
        ylabel="clearance [mm]",
        title="Below zero, the cube is in the table",
    )
    legend_below(figure)
    return figure


def contact_counts(run: Experiment) -> Figure:
    """Draw the number of reported contact points at each sample, one dropped cube in each axes.

    A triangle marks the deepest sample of each cube.
    """
    figure = plotting.figure(4)
    axes = figure.subplots(4, 1, sharex=True, sharey=True)
    for ax, (name, style) in zip(axes, LANDINGS.items(), strict=True):
        t, counts = run.traces[name].t, run.traces[name].contacts[:, 0]
        deepest = metrics.clearance(run.traces[name], run.cases[name]).argmin()
        ax.step(t, counts, where="post", **style)
        ax.plot(t[deepest], counts[deepest], marker="v", markersize=8, **style)
        title = f"{spec.LABELS[name]} (triangle: deepest sample)"
        ax.set(title=title, xlim=WINDOW, yticks=[0, 4], ylim=(-0.5, 4.8))
    axes[-1].set_xlabel("time [s]")
    return figure


def pushed(run: Experiment) -> Figure:
    """Draw speed along x, clearance and angular speed of the lab's pushed cubes."""
    figure = plotting.figure(7)
    axes = figure.subplots(3, 1, sharex=True)
    # It lies below an equal one.
    below = SLIDES["high_on_050"] | {"linewidth": 4.0, "alpha": 0.45}
    for name, style in (SLIDES | {"high_on_050": below}).items():
        trace = run.traces[name]
        clear = 1000 * metrics.clearance(trace, run.cases[name])
        curves = trace.link_vel[:, 0, 0], clear, trace.link_ang[:, 0, 1]
        for ax, curve in zip(axes, curves, strict=True):
            ax.plot(trace.t, curve, **style)
    heads = ("speed along x [m/s]", "clearance [mm]", "turning about y [rad/s]")
    for ax, head in zip(axes, heads, strict=True):
        ax.axhline(0, **LINE)
        ax.set(ylabel=head, xlim=(0, 0.9))
    axes[2].set_xlabel("time after the push [s]")
    legend_below(figure)
    return figure


def stopping_distances(run: Experiment) -> Figure:
    """Draw stopping distances as bars, each with Coulomb's distance as a mark [m]."""
    figure, ax = plotting.axes(3.2)
    for place, (name, style) in enumerate(SLIDES.items()):
        length = run.metrics[name].stop_distance
        if length is not None:
            ax.barh(place, length, height=0.55, color=style["color"])
        formula = theory.coulomb_distance(run.cases[name])
        ax.plot([formula] * 2, [place - 0.4, place + 0.4], **look("target"))
    words = [spec.LABELS[name].replace(" on ", "\non ") for name in SLIDES]
    ax.set_yticks(range(len(words)), words)
    ax.invert_yaxis()
    ax.set(xlabel="distance [m]", title="Bars: measured. Dotted marks: v² / (2 μ g)")
    return figure


def ball_energies(run: Experiment) -> Figure:
    """Draw the total energy of balls in the air, and the energy that the steps conserve."""
    figure = plotting.figure(6)
    axes = figure.subplots(2, 1, sharex=True)
    for name, style in BOUNCES.items():
        trace, case = run.traces[name], run.cases[name]
        start, clear = (
            metrics.total_energy(trace, case)[0],
            metrics.clearance(trace, case) > 0,
        )
        for ax, energy in zip(
            axes, (metrics.total_energy, metrics.conserved_energy), strict=True
        ):
            share = np.where(clear, 100 * energy(trace, case) / start, np.nan)
            ax.plot(trace.t, share, linewidth=1.5, **style)
    for ax, title in zip(
        axes, ("Total energy", "Total energy − m g h v / 2"), strict=True
    ):
        ax.set(title=title, ylabel="share of the start [%]", ylim=(50, 108))
    axes[1].set_xlabel("time [s]")
    axes[1].legend(loc="lower left")
    return figure


def kept_by_step(run: Experiment) -> Figure:
    """Draw the energy that the ball keeps at its first bounce by solver step [%]."""
    figure, ax = plotting.axes(3.2)
    balls = checks.measured(run, metrics.BounceMetrics)
    h = [1000 * run.cases[name].h for name in balls]
    shares = np.array([found.first_kept for found in balls.values()], float)
    ax.plot(h, shares, marker="o", label="measured", **look("baseline"))
    expected = 100 * theory.kept_at_bounces(spec.SPRING[1])
    ax.axhline(expected, label="linear spring", **look("target"))
    ax.axhline(100, label="no loss", **LINE)
    ax.set_ylabel("kept at the first bounce [%]")
    log_axis(ax, h, STEP_LABEL)
    legend_above(ax, "")
    return figure


# The lecture


def landings_by_step(run: Experiment) -> Figure:
    """Draw the landing from the baseline's height at four solver steps."""
    figure, ax = plotting.axes(3.6)
    for scene, mark in STEP_MARKS.items():
        case, trace = run.cases[f"{scene}_10000"], run.traces[f"{scene}_10000"]
        every = max(1, round(0.001 / trace.dt))
        style = look(mark, marker="." if case.h > 0.002 else "")
        clear = 1000 * metrics.clearance(trace, case)[::every]
        ax.plot(trace.t[::every], clear, label=f"h = {1000 * case.h:g} ms", **style)
    ax.axhline(0, **LINE)
    ax.set(
        xlim=(0.2, 0.34),
        ylim=(-26, 14),
        xlabel="time [s]",
        ylabel="clearance [mm]",
        title="Below zero: overlap",
    )
    ax.legend(loc="lower right")
    return figure


def deepest(run: Experiment) -> Figure:
    """Show two cubes at their deepest samples, without a camera the landings at four steps."""
    if not run.rendered:
        return landings_by_step(run)
    words = study_spec.DEEPEST.items()
    return plotting.stacked({text: run.frames[name][120:420] for name, text in words})


def depths_by_step(run: Experiment) -> Figure:
    """Draw each depth as a share of v T / e by the solver step."""
    figure, ax = plotting.axes(3.8)
    points = np.array(
        [
            (
                1000 * case.h,
                found.penetration / theory.depth(case),
                found.rebound > metrics.CLEAR,
            )
            for _, case, found in study.row(run, *study_spec.STEP_CASES)
        ]
    )
    for label, rebounds, marker, size, mark in (
        ("stays down", False, "o", 4.5, "first"),
        ("leaves the surface again", True, "^", 6, "second"),
    ):
        h, shares, _ = points[points[:, 2] == rebounds].T
        ax.plot(
            h, shares, marker, markersize=size, color=look(mark)["color"], label=label
        )
    ax.axhline(1, label="v T / e", **look("target"))
    log_axis(ax, points[:, 0], STEP_LABEL)
    ax.set_ylim(bottom=0)
    ax.set_ylabel("depth / (v T / e)")
    legend_above(ax, "Nine heights")
    return figure
