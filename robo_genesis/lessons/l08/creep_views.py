"""Figure and tables of held boxes, each a function of the experiment."""

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting, tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import look
from robo_genesis.core.text import scaled_value
from robo_genesis.lessons.l08 import creep
from robo_genesis.lessons.l08.creep_checks import share_of

MEASURES = False

AXES = {"friction": "friction µ", "force": "force of a pad [N]", "mass": "mass [kg]"}
"""Label of each scanned setting."""


def scans(run: Experiment) -> Figure:
    """Draw the creep over friction, force and mass: measured as points, the formula dotted."""
    figure = plotting.figure(3.4)
    axes = figure.subplots(1, len(AXES), sharey=True)
    for ax, (setting, label) in zip(axes, AXES.items(), strict=True):
        names = [*creep.SCANS[setting]]
        values = [getattr(run.cases[name], setting) for name in names]
        ax.plot(values, [1000 * run.metrics[n].creep for n in names], "o", color=look("first")["color"])
        fine = np.linspace(values[0], values[-1], 200)
        cases = [creep.changed(setting, value) for value in fine]
        ax.plot(fine, [1000 * creep.formulas(c)[1] for c in cases], ":", color=look("other")["color"])
        ax.set(xlabel=label, ylim=(0, None))
    axes[-1].axvline(creep.LIGHT, **plotting.LINE)
    axes[0].set_ylabel("creep [mm/s]")
    return figure


@tables.as_table
def changes(run: Experiment) -> Iterator[dict[str, str]]:
    """Return what users change, and the share of the creep that it leaves in both engines."""
    for name, (words, other, price) in creep.CHANGES.items():
        shares = {
            head: f"{share_of(run, engine + name, engine + other):z.3f}"
            for head, engine in (("× in Genesis", ""), ("× in MuJoCo", "mujoco_"))
        }
        depth = scaled_value(run.metrics[name].depth, "µm")
        yield {"change": words} | shares | {"depth": depth, "price": price}


@tables.as_table
def stiffer(run: Experiment) -> Iterator[dict[str, str]]:
    """Return the creep with the pyramid and other impratios, beside both formulas."""
    for scene in creep.STIFF:
        for one in ("slick", "box", "rough"):
            name = f"{scene}_{one}"
            case = run.cases[name]
            row = {"impratio": f"{case.impratio:g}", "µ": f"{case.friction:g}"}
            for head, of in (("Genesis", name), ("MuJoCo", f"mujoco_{name}")):
                row[head] = scaled_value(run.metrics[of].creep, "mm/s")
                row[f"formula of {head}"] = scaled_value(creep.formulas(case, of != name)[1], "mm/s")
            yield row
