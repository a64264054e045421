"""Tables of L07, each a function of the experiment."""

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import decimal, scaled_value
from robo_genesis.sim.bodies.bowl import CHOICES, DENSITY
from robo_genesis.sim.bodies.soft_contact import depth_and_creep

from . import bowls, rest, rungs, spec

MEASURES = False


# By rung: head, quantity, factor and digits of the value that decides in this lesson.
DECIDES = {
    "built": ("built: ball above the bowl's foot [mm]", "ball", 1000.0, 1),
    "stable": ("stable: support error [mm]", "support", 1000.0, 3),
    "seen": ("seen: pixels", "pixels", 1.0, 0),
    "reachable": ("reachable: touching postures", "touches", 1.0, 0),
    "graspable": ("graspable: rise, share of the hand's", "rise", 1.0, 2),
}


@tables.as_table
def ladder_table(run: Experiment) -> tables.Rows:
    """Return which rungs each scene fails, and of each rung the value that decides."""
    for name in rungs.scenes(run):
        row = {"scene": spec.LETTERS[name]}
        for rung, found in rungs.measured(run, name).items():
            head, quantity, factor, digits = DECIDES[rung]
            value = decimal(factor * found[quantity], digits)
            row[head] = value if rungs.passed(found) else f"**fails**, {value}"
        yield row


@tables.as_table
def grip_table(run: Experiment) -> tables.Rows:
    """Return what the lifts of the page's objects measured."""
    for name, label in spec.SHOWN_LIFTS.items():
        m, contacts = run.metrics[name], run.readings["contacts"]
        yield {
            "object": label,
            "steps in contact before closing": f"{contacts[f'{name}_descending']:g}",
            "pushed [mm]": decimal(1000 * m.pushed, 1),
            "rise [mm]": decimal(1000 * m.rise, 1),
            "hand's rise [mm]": decimal(1000 * m.hand_rise, 1),
            "tilt [mrad]": decimal(1000 * m.tilt, 0),
        }


def ends(found: bowls.BowlMetrics) -> tuple[str, str]:
    """Write how many balls are inside, and the height of the lowest: `12 of 12`, `4.9`."""
    balls = len(bowls.BALLS)
    lowest = "–" if found.lowest is None else decimal(1000 * found.lowest, 1)
    return f"{found.inside / 100 * balls:.0f} of {balls}", lowest


@tables.as_table
def bowl_table(run: Experiment) -> tables.Rows:
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


def bowl_price(run: Experiment) -> str:
    """Return the time of run and step by choice."""
    whole, step = run.readings["run"], run.readings["step"]
    rows = {
        words: (whole[choice], 1000 * step[choice]) for choice, words in CHOICES.items()
    }
    heads = {"build and 200 steps [s]": 1, "step [ms]": 2}
    return tables.timed_table("collision geometry", heads, rows)


def bowl_runs(run: Experiment, group: str) -> str:
    """Return the runs of a group: `ATTACKS` or `SMALL`."""
    rows = {}
    for name, case in getattr(bowls, group).items():
        words = f"{CHOICES[case.choice]}, h = {1000 * case.h:g} ms"
        words += f", seed {case.seed}" * (case.seed > 0) + ", from inside" * (
            case.drop < 0
        )
        words += f", start {1000 * case.shift:g} mm aside" * (case.shift > 0)
        found = run.metrics[name]
        inside, lowest = ends(found)
        rows[words] = (
            decimal(1000 * case.depth, 1),
            inside,
            f"{found.in_foot:.0f}",
            lowest,
        )
    heads = ("v T / e [mm]", "inside", "sunk in", "lowest ball [mm]")
    return tables.number_table("run", dict.fromkeys(heads, 0), rows)


# The runs of both tables of creep.
CREEPS = {
    "changes": [*rest.LABELS][:10],
    "cures": ["tilt_10_box", "T_5ms_box", *[*rest.LABELS][10:]],
}


def creep_table(run: Experiment, which: str) -> str:
    """Return creep and depth of the boxes of `CREEPS` in both engines, beside the formulas."""
    rows = []
    for name in CREEPS[which]:
        of, twin = run.metrics[name], run.metrics.get(f"mujoco_{name}")
        depth, creep = depth_and_creep(run.cases[name])
        found = {
            "creep": of.creep,
            "formula": creep,
            "MuJoCo": twin.creep if twin else None,
        }
        speeds = {
            head: scaled_value(v, "mm/s") if v is not None else "–"
            for head, v in found.items()
        }
        depths = {
            "sinks in": scaled_value(of.sunk, "µm"),
            "its formula": scaled_value(depth, "µm"),
        }
        rows.append({"box": rest.LABELS[name]} | speeds | depths)
    return tables.markdown(rows)
