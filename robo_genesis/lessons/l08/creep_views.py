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
from robo_genesis.sim.bodies.grippers import HeldCase
from robo_genesis.sim.throughput import KEPT

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
        ax.plot(
            values, [1000 * run.metrics[n].creep for n in names], "o", color=look("first")["color"]
        )
        fine = np.linspace(values[0], values[-1], 200)
        cases = [HeldCase(**{setting: value}) for value in fine]
        ax.plot(
            fine, [1000 * creep.formulas(c)[1] for c in cases], ":", color=look("other")["color"]
        )
        ax.set_xlabel(label)
    axes[-1].axvline(creep.LIGHT, **plotting.LINE)
    axes[-1].annotate("mg = µN", (creep.LIGHT, 0.1), rotation=90, va="bottom", ha="right")
    axes[0].set(ylabel="creep [mm/s]", ylim=(0, None))
    return figure


@tables.as_table
def changes(run: Experiment) -> Iterator[dict[str, str]]:
    """Return what users change, and the share of the creep that it leaves in both engines."""
    for name, (words, other, price) in creep.CHANGES.items():
        shares = {
            head: f"{share_of(run, engine + name, engine + other):z.3f}"
            for head, engine in (("Genesis", ""), ("MuJoCo", "mujoco_"))
        }
        depth = scaled_value(run.metrics[name].depth, "µm").removesuffix(" µm")
        times = {"time [ms]": time_of(run, name), "price": price}
        yield {"change": words} | shares | {"depth [µm]": depth} | times


def time_of(run: Experiment, name: str) -> str:
    """Write median, least and largest time of an outer step of a run's scene, if it is timed."""
    name = "plain_base" if name == "base" else name
    (scene,) = (one for one, cases in creep.SCENES.items() if name in cases)
    if scene not in creep.TIMED:
        return "–"
    step, least, most = (f"{1000 * run.readings['step'][f'{of}_{scene}']:.1f}" for of in KEPT)
    return f"{step} ({least} to {most})"
