"""Tables and the figure of the page on rest: functions of the experiment."""

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import legend_above, look
from robo_genesis.core.tables import as_table
from robo_genesis.core.text import scaled_value
from robo_genesis.lessons.l07 import rest

MEASURES = False

CHANGED, CURES = [*rest.LABELS][:10], ["tilt_10_box", "T_5ms_box", *[*rest.LABELS][10:]]
"""The runs of both tables of creep."""

MARKS = {"box": ("first", "μ = 0.5"), "firm": ("second", "μ = 1"), "rough": ("third", "μ = 2")}


def creeps(run: Experiment, names: list[str]) -> Iterator[dict[str, str]]:
    """Yield creep and depth of some boxes in both engines, beside the formulas."""
    for name in names:
        of, twin = run.metrics[name], run.metrics.get(f"mujoco_{name}")
        depth, creep = rest.formulas(run.cases[name])
        yield {
            "box": rest.LABELS[name], "creep": scaled_value(of.creep, "mm/s"),
            "formula": scaled_value(creep, "mm/s"),
            "MuJoCo": scaled_value(twin.creep, "mm/s") if twin else "–",
            "sinks in": scaled_value(of.sunk, "µm"), "its formula": scaled_value(depth, "µm"),
        }  # fmt: skip


@as_table
def changes(run: Experiment) -> Iterator[dict[str, str]]:
    """Return creep and depth of the boxes that differ in one setting."""
    return creeps(run, CHANGED)


@as_table
def cures(run: Experiment) -> Iterator[dict[str, str]]:
    """Return creep and depth of the box with each of the settings that may reduce its creep."""
    return creeps(run, CURES)


def by_tilt(run: Experiment) -> Figure:
    """Draw the creep over the tilt by coefficient: measured as points, the formula dotted."""
    figure, ax = plotting.axes(4.0)
    for box, (mark, label) in MARKS.items():
        names = [f"tilt_{tilt}_{box}" for tilt in (0, 5, 10, 15, 20)]
        tilts = np.degrees([run.cases[name].tilt for name in names])
        colour = look(mark)["color"]
        ax.plot(tilts, [1000 * run.metrics[n].creep for n in names], "o", color=colour, label=label)
        ax.plot(tilts, [1000 * rest.formulas(run.cases[n])[1] for n in names], ":", color=colour)
    ax.set(xlabel="tilt [°]", ylabel="creep [mm/s]", ylim=(0, None))
    legend_above(ax, "Dotted: formula")
    return figure
