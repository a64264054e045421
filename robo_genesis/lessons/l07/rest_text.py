"""Tables and the figure of the page on rest: functions of the experiment."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import legend_above, look
from robo_genesis.core.tables import markdown
from robo_genesis.core.text import scaled_value
from robo_genesis.lessons.l07.rest import LABELS, formulas

MEASURES = False

TABLES = {"changes": [*LABELS][:10], "cures": ["tilt_10_box", "T_5ms_box", *[*LABELS][10:]]}
"""The runs of both tables of creep."""

MARKS = {"box": ("first", "μ = 0.5"), "firm": ("second", "μ = 1"), "rough": ("third", "μ = 2")}


def creeps(run: Experiment, table: str) -> str:
    """Return creep and depth of the boxes of `TABLES` in both engines, beside the formulas."""
    rows = []
    for name in TABLES[table]:
        of, twin = run.metrics[name], run.metrics.get(f"mujoco_{name}")
        depth, creep = formulas(run.cases[name])
        found = {"creep": of.creep, "formula": creep, "MuJoCo": twin.creep if twin else None}
        speeds = {
            head: scaled_value(v, "mm/s") if v is not None else "–" for head, v in found.items()
        }
        depths = {"sinks in": scaled_value(of.sunk, "µm"), "its formula": scaled_value(depth, "µm")}
        rows.append({"box": LABELS[name]} | speeds | depths)
    return markdown(rows)


def by_tilt(run: Experiment) -> Figure:
    """Draw the creep over the tilt by coefficient: measured as points, the formula dotted."""
    figure, ax = plotting.axes(4.0)
    for box, (mark, label) in MARKS.items():
        names = [f"tilt_{tilt}_{box}" for tilt in (0, 5, 10, 15, 20)]
        tilts = np.degrees([run.cases[name].tilt for name in names])
        colour = look(mark)["color"]
        ax.plot(tilts, [1000 * run.metrics[n].creep for n in names], "o", color=colour, label=label)
        ax.plot(tilts, [1000 * formulas(run.cases[n])[1] for n in names], ":", color=colour)
    ax.set(xlabel="tilt [°]", ylabel="creep [mm/s]", ylim=(0, None))
    legend_above(ax, "Dotted: formula")
    return figure
