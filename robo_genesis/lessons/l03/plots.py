"""Figures of bodies that land, slide and bounce: axes in, axes out; no numerics, no show()."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from robo_genesis.core.plotting import look
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.energy import clearance, kept_energy, total_energy
from robo_genesis.lessons.l03.metrics import CLEAR
from robo_genesis.lessons.l03.study import Studies, solver_step
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import ContactCase

LANDING_MARKS = {"baseline": "baseline", "dt10_sub1": "G1", "dt20_sub2": "G3", "dt20_sub1": "G2"}
SLIDE_MARKS = {"low_on_050": "G1", "high_on_050": "G2", "low_on_030": "G3", "high_on_030": "other"}

Cases = Mapping[str, ContactCase]
Traces = Mapping[str, ContactTrace]


def heights(
    ax: Axes,
    traces: Traces,
    cases: Cases,
    window: tuple[float, float],
    marks: Mapping[str, str] = LANDING_MARKS,
) -> Axes:
    """Draw the clearance below each dropped cube at every sample, zero where it touches.

    Args:
        ax: where to draw.
        traces: by case.
        cases: those of the marks, at least.
        window: of time [s].
        marks: of the palette, by case.
    """
    for name, mark in marks.items():
        clear = 1000 * clearance(traces[name], cases[name])
        ax.plot(traces[name].t, clear, marker=".", label=name, **look(mark))
    ax.axhline(0, **look("limit"))
    ax.set_xlim(*window)
    ax.set_ylim(-26, 32)
    ax.set_xlabel("time [s]")
    ax.set_ylabel("clearance [mm]")
    ax.set_title("Below zero, the cube is in the surface", loc="left")
    ax.legend(fontsize="small", loc="upper right")
    return ax


def counted(ax: Axes, traces: Traces, window: tuple[float, float]) -> Axes:
    """Draw how many contact points the engine reports at each sample of each dropped cube."""
    for place, (name, mark) in enumerate(LANDING_MARKS.items()):
        trace = traces[name]
        ax.step(
            trace.t, trace.contacts[:, 0] + 0.12 * place, where="post", label=name, **look(mark)
        )
    ax.set_xlim(*window)
    ax.set_yticks([0, 4])
    ax.set_xlabel("time [s]")
    ax.set_ylabel("contact points")
    ax.set_title("Reported contacts (curves lie beside each other)", loc="left")
    return ax


def depths(ax: Axes, run: Studies) -> Axes:
    """Draw how deep the cubes sink in over the solver's step, those that rebound apart."""
    stays: tuple[list[float], list[float]] = ([], [])
    leaves: tuple[list[float], list[float]] = ([], [])
    for step in spec.STEPS_STUDIED:
        for found in run.landings(step):
            into = leaves if found.rebound > CLEAR else stays
            into[0].append(1000 * solver_step(step))
            into[1].append(1000 * found.penetration)
    ax.semilogx(
        *stays, "o", markersize=4.5, color=look("G1")["color"], label="stays on the surface"
    )
    ax.semilogx(*leaves, "^", markersize=6, color=look("G2")["color"], label="leaves it again")
    ax.axvline(1000 * mujoco_contacts.DEFAULT_TIME_CONSTANT / 2, **look("target"))
    h = [1000 * solver_step(step) for step in spec.STEPS_STUDIED]
    ax.set_xticks(h, [f"{step:g}" for step in h])
    ax.minorticks_off()
    ax.set_ylim(bottom=0)
    ax.set_xlabel("solver step h [ms]")
    ax.set_ylabel("penetration proxy [mm]")
    ax.set_title("One landing from nine heights, 7 mm apart", loc="left")
    ax.legend(fontsize="small", loc="upper left")
    return ax


def slides(axes: Sequence[Axes], traces: Traces, cases: Cases, marks: Mapping[str, str]) -> None:
    """Draw speed along x, clearance and angular speed of each pushed cube.

    Args:
        axes: three, one below the other.
        traces: by case.
        cases: those to draw.
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
    names = list(distances)
    for place, name in enumerate(names):
        length = distances[name]
        if length is not None:
            ax.barh(place, length, height=0.55, color=look(SLIDE_MARKS[name])["color"])
        ax.plot([formula[name]] * 2, [place - 0.4, place + 0.4], **look("target"))
    ax.set_yticks(range(len(names)), names)
    ax.invert_yaxis()
    ax.set_xlabel("distance [m]")
    ax.set_title("Bars: measured. Dotted marks: v² / (2 μ g)", loc="left")
    return ax


def energies(axes: Sequence[Axes], traces: Traces, cases: Cases) -> None:
    """Draw the energy of bouncing balls in the air, as it is read and less what the steps lend.

    Args:
        axes: two, one below the other.
        traces: by case.
        cases: up to three to draw.
    """
    for (name, case), mark in zip(cases.items(), ("G2", "other", "G3"), strict=False):
        trace = traces[name]
        start, clear = total_energy(trace, case)[0], clearance(trace, case) > 0
        for ax, energy in zip(axes, (total_energy, kept_energy), strict=True):
            share = np.where(clear, 100 * energy(trace, case) / start, np.nan)
            label = f"h = {1000 * case.h:g} ms"
            ax.plot(trace.t, share, label=label, **look(mark, linewidth=1.5))
    axes[0].set_title("Total energy", loc="left")
    axes[1].set_title("Less m g h v / 2, which semi-implicit Euler keeps in the air", loc="left")
    for ax in axes:
        ax.set_ylabel("share of the start [%]")
        ax.set_ylim(50, 108)
    axes[1].set_xlabel("time [s]")
    axes[1].legend(fontsize="small", loc="lower left")


def kept(ax: Axes, shares: Mapping[float, float | None], expected: float) -> Axes:
    """Draw the share of energy that is kept at the first bounce over the solver's step.

    Args:
        ax: where to draw.
        shares: by solver step [s], in percent.
        expected: what a linear spring of that damping keeps [%].
    """
    h = [1000 * step for step in shares]
    ax.semilogx(h, list(shares.values()), marker="o", label="measured", **look("baseline"))
    ax.axhline(expected, label="linear spring, continuous time", **look("target"))
    ax.axhline(100, label="nothing lost", **look("limit"))
    ax.set_xticks(h, [f"{step:g}" for step in h])
    ax.minorticks_off()
    ax.set_xlabel("solver step h [ms]")
    ax.set_ylabel("kept at the first bounce [%]")
    ax.legend(fontsize="small", loc="lower left")
    return ax
