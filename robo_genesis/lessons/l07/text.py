"""Tables of L07, each a function of the experiment."""

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import decimal, scaled_value
from robo_genesis.sim.bodies.bowl import CHOICES, DENSITY
from robo_genesis.sim.bodies.soft_contact import depth_and_creep

from . import bowls, rest, rungs, spec, student

MEASURES = False


# By rung the quantity that decides in this lesson, with words.
DECIDES = {
    "built": ("ball", "ball above the bowl's foot"),
    "stable": ("carried", "carried share of the weight"),
    "seen": ("pixels", "pixels"),
    "reachable": ("touches", "touching postures"),
    "graspable": ("rise", "rise, share of the hand's"),
}


@tables.as_table
def ladder_table(run: Experiment) -> tables.Rows:
    """Return which rungs each scene fails, and of each rung the value that decides."""
    for name in rungs.scenes(run):
        row = {"scene": spec.LETTERS[name]}
        for rung, found in rungs.measured(run, name).items():
            quantity, words = DECIDES[rung]
            value = student.number(quantity, found[quantity])
            fails = "" if rungs.passed(found) else "**fails**, "
            row[f"{rung}: {words}"] = fails + value
        yield row


# Words for the quantities that catch scenes.
CATCHES = {
    None: "–",
    "carried": "carried share of the weight",
    "margin": "smallest margin",
    "accepted": "accepted answers (of 3):",
    "friction": "friction differs by",
    "touches": "touching postures (of 33):",
    "pushed": "moved by a push",
    "grasp": "fingertips above the shelf",
}


@tables.as_table
def attack_table(run: Experiment) -> tables.Rows:
    """Return which rung each scene fails that was made to fool the ladder, and by which value."""
    for name, (_, quantity) in spec.ATTACKS.items():
        found = run.readings["caught"].get(name)
        value = student.number(quantity, found) if quantity else ""
        rung = rungs.NUMBERS[int(run.readings["attacks"][name])]
        scene, _, misleads = name.partition(": ")
        yield {
            "scene": scene,
            "what misleads": misleads,
            "fails": rung or "none",
            "caught by": f"{CATCHES[quantity]} {value}".replace("-", "−"),
        }


@tables.as_table
def grip_table(run: Experiment) -> tables.Rows:
    """Return what the lifts of the page's objects measured."""
    for name, label in spec.SHOWN_LIFTS.items():
        m, of = run.metrics[name], run.readings
        read = {**of["ladder"], **of["contacts"]}
        yield {
            "object": label,
            "steps in contact before closing": f"{read[f'{name}_descending']:g}",
            "moved before closing [mm]": decimal(1000 * m.pushed, 1),
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


def bowl_runs(run: Experiment, group: str) -> str:
    """Return the runs of a group: `ATTACKS` or `SMALL`."""
    rows = {}
    for name, case in getattr(bowls, group).items():
        words = f"{CHOICES[case.choice]}, h = {1000 * case.h:g} ms{bowls.CHANGED.get(name, '')}"
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


def creep_table(run: Experiment) -> str:
    """Return creep and depth of boxes in both engines, beside the formulas."""
    rows = []
    for name, words in rest.LABELS.items():
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
        rows.append({"box": words} | speeds | depths)
    return tables.markdown(rows)
