"""The sweep as the data of an explorer: a map of the gains for each load."""

from itertools import product
from typing import Any

from robo_genesis.core import maps
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import decimal

from . import spec

MEASURES = False

# Label and noun of each group of readings that the map shows.
SHOWN = {
    "sweep_end": (
        "distance at the end [mm]",
        "distance of the hand from its target at the end",
    ),
    "sweep_overshoot": (
        "overshoot [mm]",
        "distance by which the hand passes its target",
    ),
}


def explored(run: Experiment) -> dict[str, Any]:
    """Return the sweep as `site/figures/explorer.py` shows it: KP upwards, KV to the right."""
    words = {"lower": "lower", "higher": "higher", "margin": 1.0, "within": "1 mm"}
    measures = [
        {"label": label, "noun": noun, "column": k} | words
        for k, (label, noun) in enumerate(SHOWN.values())
    ]
    return {
        "choices": ("In the hand", "Map shows"),
        "maps": [_map(run, load) for load in spec.LOADS],
        "measures": measures,
        "columns": [measure["label"] for measure in measures],
        "notes": {"●": "●: the plain robot."},
        "curves": {"drawn": []},
        "without_script": "The map needs JavaScript. The table of the sweep shows a part of it.",
    }


def _map(run: Experiment, load: float) -> dict[str, Any]:
    """Return the robots with one load."""
    label = f"{load:g} kg" if load else "nothing"
    factors = [f"{factor:g}".removeprefix("0") for factor in spec.FACTORS]
    pairs = product(spec.FACTORS, repeat=2)
    return maps.grid(
        "Factors of KP upwards, of KV to the right.",
        factors,
        factors,
        [_cell(run, kp, kv, load) for kp, kv in pairs],
        label=label,
        setting=f"{label} in the hand",
    )


def _cell(run: Experiment, kp: float, kv: float, load: float) -> dict[str, Any]:
    """Return one robot."""
    numbers = [1000 * run.readings[group][spec.SWEEP[kp, kv, load]] for group in SHOWN]
    ends, passed = texts = [
        decimal(number, 1 if number < 9.95 else 0) for number in numbers
    ]
    name = f"KP × {kp:g}, KV × {kv:g}"
    return {
        "name": name,
        "tag": "●" * (kp == kv == 1),
        "opens": (kp, kv, load) == spec.SWEPT["plain_robot"],
        "sentence": f"{name}: passes the target by {passed} mm, ends {ends} mm from it.",
        "values": [f"{text} mm" for text in texts],
        "numbers": numbers,
        "texts": texts,
    }
