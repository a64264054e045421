"""The figure of the page about many solutions."""

from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.palette import PARTS
from robo_genesis.core.plotting import look
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05 import study
from robo_genesis.lessons.l05.solutions_text import CRITERIA, chosen
from robo_genesis.sim.arm_kinematics import ARM

FAMILIES = ("first", "second", "third", "other", "further")
"""The mark of each curve of solutions, the longest first."""

PANELS = {
    "joint2 [rad]": "joint2",
    "largest angle\nfrom start [rad]": "from_start",
    "distance from\nlimits [rad]": "margin",
    "manipulability": "manipulability",
}


def solutions(run: Experiment) -> Figure:
    """Draw the accepted answers and their curves over joint1; a square is at the best answer."""
    figure, q = plotting.figure(7.6), run.traces["many_starts"].q[1:, :ARM].astype(float)
    start, families = run.traces["many_starts"].q[0, :ARM], study.solution_families(run)

    def known(at: FloatArray) -> dict[str, FloatArray]:
        return {"joint2": at[:, 1]} | study.qualities(at, start)

    best = dict(zip((key for key, _ in CRITERIA.values()), chosen(run).values(), strict=True))
    axes = figure.subplots(len(PANELS), 1, sharex=True)
    for ax, (label, key) in zip(axes, PANELS.items(), strict=True):
        ax.set_ylabel(label)
        for n, (mark, (curve, inside)) in enumerate(zip(FAMILIES, families, strict=False), 1):
            style = look(mark, linestyle="-", linewidth=1)
            ax.plot(curve[:, 0], known(curve)[key], **style)
            ax.plot(q[inside, 0], known(q[inside])[key], "o", markersize=3.5, color=style["color"])
            if ax is axes[0]:
                middle = curve[len(curve) // 2]
                ax.text(middle[0], middle[1] - 0.5, f"curve {n}", ha="center", va="top")
        if key in best:
            square = {"markersize": 10, "fillstyle": "none", "color": PARTS["text"].light}
            ax.plot(q[best[key], 0], known(q[[best[key]]])[key], "s", **square)
    axes[-1].set_xlabel("joint1 [rad]")
    return figure
