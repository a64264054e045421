"""Tables and figure of the page on meshes."""

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import BAND, LINE, look
from robo_genesis.core.tables import as_table, number_table, timed_table
from robo_genesis.core.text import decimal
from robo_genesis.lessons.l07 import bowls
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.bowl import CHOICES, DENSITY

MEASURES = False


def ends(found: bowls.BowlMetrics) -> tuple[str, str]:
    """Write how many balls are inside, and the height of the lowest: `12 of 12`, `4.9`."""
    balls = len(bowls.BALLS)
    lowest = "–" if found.lowest is None else decimal(1000 * found.lowest, 1)
    return f"{found.inside / 100 * balls:.0f} of {balls}", lowest


@as_table
def choices(run: Experiment) -> Iterator[dict[str, str]]:
    """Return geoms, volume, balls and mass by choice."""
    volume = run.readings["bowl_volume"]
    for choice, words in CHOICES.items():
        inside, lowest = ends(run.metrics[f"in_{choice}"])
        yield {
            "collision geometry": words,
            "geoms": f"{run.readings['bowl_geoms'][choice]:.0f}",
            "volume / visual": f"{volume[choice] / volume['visual']:.2f}",
            "balls inside": inside,
            "lowest ball [mm]": lowest,
            "free bowl [g]": f"{1000 * run.readings['bowl_mass'][choice]:.1f}",
            "density × visual volume [g]": f"{1e-3 * DENSITY * volume['visual']:.1f}",
        }


def price(run: Experiment) -> str:
    """Return the time of build and step by choice."""
    build, step = run.readings["build"], run.readings["step"]
    rows = {words: (build[choice], 1000 * step[choice]) for choice, words in CHOICES.items()}
    return timed_table("collision geometry", {"build [s]": 1, "step [ms]": 2}, rows)


def tried(run: Experiment, group: str) -> str:
    """Return the runs of a group: `ATTACKS` or `SMALL`."""
    rows = {}
    for name, case in getattr(bowls, group).items():
        words = f"{CHOICES[case.choice]}, h = {1000 * case.h:g} ms"
        words += f", seed {case.seed}" * (case.seed > 0) + ", from inside" * (case.drop < 0)
        words += f", start {1000 * case.shift:g} mm aside" * (case.shift > 0)
        found = run.metrics[name]
        inside, lowest = ends(found)
        rows[words] = decimal(1000 * case.depth, 1), inside, f"{found.sunk:.0f}", lowest
    heads = ("v T / e [mm]", "inside", "sunk in", "lowest ball [mm]")
    return number_table("run", dict.fromkeys(heads, 0), rows)


def section(run: Experiment) -> Figure:
    """Draw the top of the collision geometry over the bowl's wall, cut at y = 0, by choice."""
    figure = plotting.figure(3.8)
    axes = figure.subplots(len(bowls.CUT), 1, sharex=True, sharey=True)
    outer, inner = (1000 * of * (np.cos(np.pi / bowl.SECTIONS), 1) for of in bowl.profiles())
    half = np.vstack([outer, inner[::-1]])
    wall = np.vstack([half, half[::-1] * (-1, 1)])
    for ax, choice in zip(axes, bowls.CUT, strict=True):
        ax.fill(*wall.T, color=BAND, label="the mesh")
        ax.plot(*wall.T, **LINE)
        tops = 1000 * np.array([*run.readings[f"top_{choice}"].values()])
        ax.plot(1000 * bowls.ACROSS, tops, label="top of the collision geometry", **look("second"))
        ax.set(aspect="equal", ylabel="z [mm]", ylim=(-3, 56), yticks=[0, 25, 50])
        ax.set_title(CHOICES[choice].capitalize())
    axes[-1].set_xlabel("x [mm]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower left", ncols=2)
    return figure
