"""Figures of a dropped box. Each function draws on given axes and returns them."""

from matplotlib.axes import Axes

from robo_genesis.core.free_fall import continuous_drop
from robo_genesis.core.plotting import look
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02.metrics import fallen
from robo_genesis.lessons.l02.study import StepStudy
from robo_genesis.sim.rigid_bodies import Drop


def height(ax: Axes, trace: BodyTrace, case: Drop) -> Axes:
    """Draw the height of the box's centre at every sample, and its height on the ground."""
    ax.plot(trace.t, trace.link_pos[:, 0, 2], marker=".", label="measured, get_links_pos",
            **look("baseline"))  # fmt: skip
    ax.axhline(case.size / 2, label="centre of a box on the ground", **look("limit"))
    ax.set_ylim(bottom=0)
    ax.set(xlabel="time [s]", ylabel="height z [m]")
    ax.set_title("Height of the box", loc="left")
    ax.legend(fontsize="small", loc="center left")
    return ax


def speed(ax: Axes, trace: BodyTrace, case: Drop) -> Axes:
    """Draw the speed downwards at every sample, beside g t."""
    ax.plot(trace.t, -trace.link_vel[:, 0, 2], marker=".", label="measured, get_links_vel",
            **look("baseline"))  # fmt: skip
    ax.plot(trace.t, case.gravity * trace.t, label="g t", **look("target"))
    ax.set(xlabel="time [s]", ylabel="speed downwards [m/s]")
    ax.set_title("Speed of the box", loc="left")
    ax.legend(fontsize="small", loc="upper left")
    return ax


def three_drops(ax: Axes, trace: BodyTrace, case: Drop, formula: FloatArray) -> Axes:
    """Draw how much farther than g t² / 2 the box is, measured and by the stepped formula.

    The differences are a small part of the fall, so three curves of height would coincide.

    Args:
        ax: where to draw.
        trace: the run.
        case: its gravity enters g t² / 2.
        formula: drop by the stepped formula at each sample, (n+1,) [m].
    """
    continuous = continuous_drop(trace.t, case.gravity)
    ax.axhline(0, label="continuous: g t² / 2", **look("target"))
    ax.plot(trace.t, 1000 * (formula - continuous), label="stepped: g h² n (n + 1) / 2",
            **look("other"))  # fmt: skip
    ax.plot(trace.t, 1000 * (fallen(trace) - continuous), "o", markersize=4.5, label="measured",
            color=look("baseline")["color"])  # fmt: skip
    ax.set(xlabel="time [s]", ylabel="farther down [mm]")
    ax.set_title("Against continuous free fall", loc="left")
    ax.legend(fontsize="small", loc="upper left")
    return ax


def gaps(ax: Axes, study: StepStudy) -> Axes:
    """Draw the distance ahead of continuous free fall at the end of the run by solver step."""
    h = 1000 * study.h
    ax.loglog(h, 1000 * study.expected, label="g h t / 2", **look("other"))
    ax.loglog(h, 1000 * study.gaps, "o", markersize=6, label="measured",
              color=look("baseline")["color"])  # fmt: skip
    ax.set(xlabel="solver step h [ms]", ylabel="farther down at the end [mm]")
    ax.set_title("Difference at the end, by solver step", loc="left")
    ax.set_xticks(h, [f"{step:g}" for step in h])
    ax.set_yticks([0.5, 1, 2, 5, 10], ["0.5", "1", "2", "5", "10"])
    ax.minorticks_off()
    ax.legend(fontsize="small", loc="upper left")
    return ax
