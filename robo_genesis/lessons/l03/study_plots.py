"""Figures of the lecture and the deeper pages: functions of the experiment, and of axes."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import LINE, legend_above, look
from robo_genesis.lessons.l03 import friction, plots, study, study_contact, study_spec, theory
from robo_genesis.lessons.l03.energy import clearance
from robo_genesis.lessons.l03.metrics import CLEAR
from robo_genesis.lessons.l03.study import slide

MEASURES = False

STEP_MARKS = {
    "h_20000us_10000": "second",
    "h_10000us_10000": "third",
    "h_5000us_10000": "baseline",
    "h_125us_10000": "first",
}
CONE_MARKS = {
    "low_on_050": "first",
    "high_on_050": "second",
    "low_on_050_elliptic": "third",
    "high_on_050_elliptic": "other",
}
CONE_LABELS = {
    "low_on_050": "pyramid, μ = 0.5",
    "high_on_050": "pyramid, μ = 0.8",
    "low_on_050_elliptic": "elliptic, μ = 0.5",
    "high_on_050_elliptic": "elliptic, μ = 0.8",
}
LANE_MARKS = {"low": "first", "high": "second"}
RELEASE_MARKS = {"release_10ms": "baseline", "release_5ms": "first", "release_2ms": "second"}
LABELS = {"low": "μ = 0.5", "high": "μ = 0.8"}


def landings_by_step(run: Experiment) -> Figure:
    """Draw the landing from the baseline's height at four solver steps."""
    figure, ax = plotting.axes(3.6)
    for name, mark in STEP_MARKS.items():
        case, trace = run.cases[name], run.traces[name]
        every = max(1, round(0.001 / trace.dt))
        label = f"h = {1000 * case.h:g} ms"
        dots = "." if case.h > 0.002 else ""
        clear = 1000 * clearance(trace, case)[::every]
        ax.plot(trace.t[::every], clear, marker=dots, label=label, **plots.solid(mark))
    ax.axhline(0, **LINE)
    ax.set(xlim=(0.2, 0.34), ylim=(-26, 14), xlabel="time [s]", ylabel="clearance [mm]")
    ax.set_title("Below zero: overlap", loc="left")
    ax.legend(loc="lower right")
    return figure


def depths_by_step(run: Experiment) -> Figure:
    """Draw each depth as a share of v T / e by the solver step."""
    figure = plotting.figure(3.8)
    depths(figure.subplots(), run)
    return figure


def depths(ax: Axes, run: Experiment) -> Axes:
    """Draw each depth as a share of v T / e, with a mark for the cubes that rebound."""
    points = [
        (1000 * study.case_of(scene).h, share, found.rebound > CLEAR)
        for scene in study_spec.STEP_CASES
        for share, found in zip(
            study.depth_shares(run.metrics, scene),
            study.landings_of(run.metrics, scene),
            strict=True,
        )
    ]
    for label, rebounds, marker, size, mark in (
        ("stays down", False, "o", 4.5, "first"),
        ("leaves the surface again", True, "^", 6, "second"),
    ):
        drawn = [(h, share) for h, share, leaves in points if leaves == rebounds]
        h, shares = zip(*drawn, strict=True) if drawn else ((), ())
        ax.semilogx(h, shares, marker, markersize=size, color=look(mark)["color"], label=label)
    ax.axhline(1, label="v T / e", **look("target"))
    ticks = sorted({h for h, *_ in points})
    ax.set_xticks(ticks, [f"{step:g}" for step in ticks])
    ax.minorticks_off()
    ax.set_ylim(bottom=0)
    ax.set(xlabel="solver step h [ms]", ylabel="depth / (v T / e)")
    legend_above(ax, "Nine heights")
    return ax


def hops(run: Experiment) -> Figure:
    """Draw the hops by solver step and by speed, with the formula of one step."""
    figure = plotting.figure(7)
    by_step, by_speed = figure.subplots(2, 1)
    for lane, mark in LANE_MARKS.items():
        cases = {f"{s}_{lane}": of[f"{s}_{lane}"] for s, of in study_spec.HOP_STEP_CASES.items()}
        h = [1000 * case.h for case in cases.values()]
        found = [1000 * slide(run.metrics, name).hop for name in cases]
        formula = [1000 * theory.hop(case) for case in cases.values()]
        colour = look(mark)["color"]
        by_step.loglog(h, found, "o", color=colour, label=LABELS[lane])
        by_step.loglog(h, formula, color=colour, linestyle=":", linewidth=1.4)
    by_step.set(xlabel="solver step h [ms]", ylabel="hop [mm]", ylim=(0.01, 100))
    ticks = sorted({1000 * of[f"{s}_low"].h for s, of in study_spec.HOP_STEP_CASES.items()} - {2})
    by_step.set_xticks(ticks, [f"{step:g}" for step in ticks])
    by_step.set_title("Push at 2 m/s", loc="left")
    by_step.legend(loc="lower right")
    slow = study_spec.HOP_SPEED_CASES
    speeds = [case.speed for case in slow.values()]
    colour = look("first")["color"]
    heights = [1000 * slide(run.metrics, name).hop for name in slow]
    by_speed.loglog(speeds, heights, "o", color=colour)
    formula = [1000 * theory.hop(case) for case in slow.values()]
    by_speed.loglog(speeds, formula, color=colour, linestyle=":", linewidth=1.4)
    by_speed.set(xlabel="speed of the push [m/s]", ylabel="hop [mm]", ylim=(0.01, 100))
    by_speed.set_title("h = 5 ms, μ = 0.5", loc="left")
    by_speed.set_xticks(speeds, [f"{speed:g}" for speed in speeds])
    for ax in (by_step, by_speed):
        ax.set_yticks([0.01, 0.1, 1, 10, 100], ["0.01", "0.1", "1", "10", "100"])
        ax.minorticks_off()
    return figure


def cones(run: Experiment) -> Figure:
    """Draw speed, clearance and angular speed with both friction models."""
    figure = plotting.figure(7)
    cases = {name: run.cases[name] for name in CONE_MARKS}
    axes = figure.subplots(3, 1, sharex=True)
    plots.slides(axes, run.traces, cases, CONE_MARKS, CONE_LABELS)
    plots.legend_below(figure)
    return figure


def stops(run: Experiment) -> Figure:
    """Draw the stopping distances of both pushed cubes by solver step, beside Coulomb's."""
    figure, ax = plotting.axes(3.4)
    for lane, mark in LANE_MARKS.items():
        cases = study_contact.runs_of_lane(lane)
        found = study_contact.stops_of_lane(run, lane)
        drawn = [(1000 * cases[name].h, d) for name, d in found.items() if d is not None]
        colour, case = look(mark)["color"], run.cases[study_contact.LANES[lane]]
        if drawn:
            h, distance = zip(*drawn, strict=True)
            ax.semilogx(h, distance, "o-", color=colour, label=LABELS[lane])
        mu = friction.pair_friction(case)
        formula = friction.coulomb_distance(case.speed, mu, case.gravity)
        ax.axhline(formula, color=colour, linestyle=":", linewidth=1.4)
    ticks = (0.1, 0.25, 0.5, 1, 2.5, 5)
    ax.set_xticks(ticks, [f"{step:g}" for step in ticks])
    ax.minorticks_off()
    ax.set(xlabel="solver step h [ms]", ylabel="stopping distance [m]", ylim=(0.15, 0.5))
    legend_above(ax, "Dotted: v² / (2 μ g)")
    return figure


def releases(run: Experiment) -> Figure:
    """Draw the landing from the baseline's height for three time constants, beside the theory."""
    figure, ax = plotting.axes(3.8)
    for scene, mark in RELEASE_MARKS.items():
        name = f"{scene}_10000"
        case, trace = run.cases[name], run.traces[name]
        t = 1000 * (trace.t - np.sqrt(2 * (case.start[2] - case.rest_height) / case.gravity))
        colour, seconds = look(mark)["color"], theory.contact_seconds(case)
        label = f"T = {1000 * seconds:g} ms"
        ax.plot(t, 1000 * clearance(trace, case), color=colour, label=label)
        ideal = np.linspace(0, 2 * seconds, 80)
        depth = theory.impact_speed(case) * ideal * np.exp(-ideal / seconds)
        ax.plot(1000 * ideal, -1000 * depth, color=colour, linestyle=":", linewidth=1.4)
        ax.plot(2000 * seconds, -1000 * depth[-1], "o", color=colour, markersize=5)
    ax.axhline(0, **LINE)
    ax.set(xlim=(-5, 55), ylim=(-9, 4), xlabel="time after touchdown [ms]")
    ax.set_ylabel("clearance [mm]")
    legend_above(ax, "Dotted: linear contact")
    return figure
