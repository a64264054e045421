"""Figures of bodies that land, slide and bounce; each function draws on given axes."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.plotting import look
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.energy import clearance, conserved_energy, total_energy
from robo_genesis.lessons.l03.metrics import CLEAR
from robo_genesis.lessons.l03.study import landings_at, solver_step
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import ContactCase

LANDING_MARKS = {
    "baseline": "baseline",
    "dt10_sub1": "first",
    "dt20_sub2": "third",
    "dt20_sub1": "second",
}
SLIDE_MARKS = {
    "low_on_050": "first",
    "high_on_050": "second",
    "low_on_030": "third",
    "high_on_030": "other",
}

Cases = Mapping[str, ContactCase]
Traces = Mapping[str, ContactTrace]


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
        ax.plot(traces[name].t, clear, marker=".", label=name, **look(mark))
    ax.axhline(0, **look("limit"))
    ax.set(xlim=window, ylim=(-26, 32), xlabel="time [s]", ylabel="clearance [mm]")
    ax.set_title("Below zero, the cube is in the surface", loc="left")
    ax.legend(fontsize="small", loc="upper right")
    return ax


def counted(ax: Axes, traces: Traces, window: tuple[float, float]) -> Axes:
    """Draw the number of reported contact points at each sample of each dropped cube."""
    for place, (name, mark) in enumerate(LANDING_MARKS.items()):
        count = traces[name].contacts[:, 0] + 0.12 * place
        ax.step(traces[name].t, count, where="post", label=name, **look(mark))
    ax.set(xlim=window, yticks=[0, 4], xlabel="time [s]", ylabel="contact points")
    ax.set_title("Reported contacts (curves lie beside each other)", loc="left")
    return ax


def depths(ax: Axes, metrics: Mapping[str, CaseMetrics]) -> Axes:
    """Draw the penetration of the cubes by solver step, with a mark for those that rebound."""
    h = {name: 1000 * solver_step(name) for name in spec.STEPS_STUDIED}
    points = [(h[name], found) for name in h for found in landings_at(metrics, name)]
    for label, rebounds, marker, size, mark in (
        ("stays on the surface", False, "o", 4.5, "first"),
        ("leaves it again", True, "^", 6, "second"),
    ):
        drawn = [(x, 1000 * f.penetration) for x, f in points if (f.rebound > CLEAR) == rebounds]
        x, depth = zip(*drawn, strict=True) if drawn else ((), ())
        ax.semilogx(x, depth, marker, markersize=size, color=look(mark)["color"], label=label)
    ax.axvline(1000 * mujoco_contacts.DEFAULT_TIME_CONSTANT / 2, **look("target"))
    ax.set_xticks(list(h.values()), [f"{step:g}" for step in h.values()])
    ax.minorticks_off()
    ax.set_ylim(bottom=0)
    ax.set(xlabel="solver step h [ms]", ylabel="penetration proxy [mm]")
    ax.set_title("One landing from nine heights, 7 mm apart", loc="left")
    ax.legend(fontsize="small", loc="upper left")
    return ax


def slides(axes: Sequence[Axes], traces: Traces, cases: Cases, marks: Mapping[str, str]) -> None:
    """Draw speed along x, clearance and angular speed of each pushed cube.

    Args:
        axes: three, one below another.
        traces: by case.
        cases: the cases to draw.
        marks: of the palette, by case.
    """
    for name, case in cases.items():
        trace, style = traces[name], look(marks[name])
        axes[0].plot(trace.t, trace.link_vel[:, 0, 0], label=name, **style)
        axes[1].plot(trace.t, 1000 * clearance(trace, case), label=name, **style)
        axes[2].plot(trace.t, trace.link_ang[:, 0, 1], label=name, **style)
    labels = ("speed along x [m/s]", "clearance [mm]", "turning about y [rad/s]")
    for ax, label in zip(axes, labels, strict=True):
        ax.set_ylabel(label)
        ax.axhline(0, color="#7a7a7a", linewidth=0.8)
        ax.set_xlim(0, 0.9)
    axes[0].legend(fontsize="small", loc="upper right")
    axes[2].set_xlabel("time after the push [s]")


def stopping(ax: Axes, distances: Mapping[str, float | None], formula: Mapping[str, float]) -> Axes:
    """Draw stopping distances as bars, each with Coulomb's distance as a mark [m]."""
    for place, (name, length) in enumerate(distances.items()):
        if length is not None:
            ax.barh(place, length, height=0.55, color=look(SLIDE_MARKS[name])["color"])
        ax.plot([formula[name]] * 2, [place - 0.4, place + 0.4], **look("target"))
    ax.set_yticks(range(len(distances)), list(distances))
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
            ax.plot(trace.t, share, label=label, **look(mark, linewidth=1.5))
    axes[0].set_title("Total energy", loc="left")
    axes[1].set_title("Less m g h v / 2, which semi-implicit Euler keeps in the air", loc="left")
    for ax in axes:
        ax.set(ylabel="share of the start [%]", ylim=(50, 108))
    axes[1].set_xlabel("time [s]")
    axes[1].legend(fontsize="small", loc="lower left")


def kept(ax: Axes, shares: Mapping[float, float | None], expected: float) -> Axes:
    """Draw the share of the energy that is kept at the first bounce by solver step.

    Args:
        ax: where to draw.
        shares: by solver step [s], in percent.
        expected: the share that a linear spring with the same damping keeps [%].
    """
    h = [1000 * step for step in shares]
    ax.semilogx(h, list(shares.values()), marker="o", label="measured", **look("baseline"))
    ax.axhline(expected, label="linear spring, continuous time", **look("target"))
    ax.axhline(100, label="nothing lost", **look("limit"))
    ax.set_xticks(h, [f"{step:g}" for step in h])
    ax.minorticks_off()
    ax.set(xlabel="solver step h [ms]", ylabel="kept at the first bounce [%]")
    ax.legend(fontsize="small", loc="lower left")
    return ax
