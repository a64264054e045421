"""What L07's lab says about its scenes: the good one and the student's own."""

from collections.abc import Callable, Mapping
from copy import deepcopy
from typing import Any

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, listed, scaled_value

from . import rungs, spec
from .study import Facts

MEASURES = False

# By quantity: its value, and the least and the largest one that passes.
Results = dict[str, tuple[float, float, float]]

# Quantities that are printed in percent.
SHARES = ("carried", "mass", "share", "rise")


def given(facts: Facts, *names: str) -> Results:
    """Return quantities that the course measured, with their limits."""
    found = {name: value for of in facts.values.values() for name, value in of.items()}
    return {name: (found[name], *spec.LIMITS[name]) for name in names}


def attempt(rung: Callable[[Facts], Results], facts: Facts) -> Results:
    """Return what a rung measures, and print it."""
    found = rung(facts)
    for name, (value, least, most) in found.items():
        verdict = "passes" if least <= value <= most else "FAILS"
        print(f"{name:10} {number(name, value):>10}   {verdict}")
    return found


def number(name: str, value: Any) -> str:
    """Return the value of a quantity with its unit."""
    if name in SHARES:
        text = f"{100 * value:z.1f} %"
    elif spec.UNITS.get(name) == "m":
        text = scaled_value(value, "mm" if abs(value) >= 1e-4 else "µm")
    else:
        text = f"{value:g}"
    return text.replace("-", "−")


def compared(
    ladder: Callable[..., Any], results: Mapping[str, Results], facts: Facts
) -> str:
    """Return the verdicts of the student's functions and of the course, and what they mean.

    Args:
        ladder: the student's.
        results: by rung what the student's functions found.
        facts: of the same scene.
    """
    if lacking := [rung for rung in facts.values if rung not in results]:
        raise NotImplementedError(
            f"There are no results of {listed(lacking)}. Run the cells above that measure them, "
            "and write the functions that they need."
        )
    lines, failed = [f"{'rung':10} {'yours':8} course"], []
    for rung, values in facts.values.items():
        mine = "FAILS" if ladder({rung: dict(results[rung])}) else "passes"
        if not rungs.passed(values):
            failed.append(rung)
        lines.append(f"{rung:10} {mine:8} {'FAILS' if rung in failed else 'passes'}")
    first = ladder(deepcopy(results)) or "none"
    lines.append(f"The first rung that fails by your ladder: {first}.")
    lines.append(f"The scene {outcome(failed)}")
    return "\n".join(lines)


def outcome(failed: list[str]) -> str:
    """Return which rungs a scene fails, as the end of a sentence."""
    return f"fails {listed(failed)}." if failed else "passes all five rungs."


def conclusions(run: Experiment) -> str:
    """Return the sentences about the good scene."""
    found = rungs.measured(run, "baseline")
    t = {
        name: number(name, value) for of in found.values() for name, value in of.items()
    }
    seen = (
        "one camera shows"
        if run.rendered
        else "without a camera, its outline would have"
    )
    return bullets(
        [
            f"The scene {outcome(rungs.failed(run, 'baseline'))}",
            "Built: the object's footprint has a margin of "
            f"{t['margin']}, and its mass differs from "
            f"density × volume by {t['mass']}.",
            f"Stable: contacts carry {t['carried']} of the weight, the object ends "
            f"{t['support']} from its exact height, and in the last "
            f"0.2 s no coordinate changed by more than {t['moved']}. A push moves it by "
            f"{t['pushed']}.",
            f"Seen: {seen} {t['pixels']} pixels, {t['share']} of the whole outline.",
            f"Reachable: {t['accepted']} of 3 answers are accepted, with the fingertips "
            f"{t['pregrasp']} and {t['grasp']} above the table, and {t['over']} above the rim of "
            f"the bowl. The robot touches something in {t['touches']} postures of its way.",
            f"Graspable: the open hand touches the object in {t['descending']} steps. The object's "
            f"rise is {t['rise']} of the hand's.",
        ]
    )
