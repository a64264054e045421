"""Tables and figure of the page on meshes."""

import numpy as np
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.plotting import BAND, LINE, look
from robo_genesis.core.tables import markdown, number_table, timed_table
from robo_genesis.lessons.l07 import bowls
from robo_genesis.lessons.l07.bowl_checks import sunk
from robo_genesis.lessons.l07.bowls import BALLS, CHOICES, DENSITY

MEASURES = False


def millimetres(value: float | None) -> str:
    """Write a length: `4.9`."""
    return "–" if value is None else f"{1000 * value:.1f}".replace("-", "−")


def counted(found: bowls.BowlMetrics) -> str:
    """Write how many balls are inside: `12 of 12`."""
    return f"{found.inside / 100 * len(BALLS):.0f} of {len(BALLS)}"


def choices(run: Experiment) -> str:
    """Return geoms, volume, balls and mass by choice."""
    rows = []
    for choice, words in CHOICES.items():
        seen, found = run.readings["visual_volume"][choice], run.metrics[f"in_{choice}"]
        rows.append(
            {
                "collision geometry": words,
                "geoms": f"{run.readings['bowl_geoms'][choice]:.0f}",
                "volume / visual": f"{run.readings['collision_volume'][choice] / seen:.2f}",
                "balls inside": counted(found),
                "lowest ball [mm]": millimetres(found.lowest),
                "free bowl [g]": f"{1000 * run.readings['bowl_mass'][choice]:.1f}",
                "density × visual volume [g]": f"{1e-3 * DENSITY * seen:.1f}",
            }
        )
    return markdown(rows)


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
        by_hand, lowest = millimetres(case.depth), millimetres(found.lowest)
        rows[words] = by_hand, counted(found), sunk(run, name), lowest
    heads = ("v T / e [mm]", "inside", "sunk in", "lowest ball [mm]")
    return number_table("run", dict.fromkeys(heads, 0), rows)


def section(run: Experiment) -> Figure:
    """Draw the top of the collision geometry over the bowl's wall, cut at y = 0, by choice."""
    figure = plotting.figure(5.4)
    axes = figure.subplots(len(bowls.CUT), 1, sharex=True, sharey=True)
    outer, inner = (1000 * of * (np.cos(np.pi / bowls.SECTIONS), 1) for of in bowls.profiles())
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
