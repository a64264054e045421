"""The ladder: what each rung measures of a scene, and whether the scene passes it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l07 import spec
from robo_genesis.lessons.l07.metrics import BALL
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.table import TABLE, SceneCase

MEASURES = False

CAMERAS = ("world", "wrist")

Footprint = tuple[float, float, float, float]
"""Centre x and y, length and width of an upright rectangle [m]."""


def gap(one: Footprint, other: Footprint) -> float:
    """Return the distance of two footprints [m], negative where they overlap."""
    apart = np.abs(np.subtract(one[:2], other[:2])) - np.add(one[2:], other[2:]) / 2
    return float(np.hypot(*apart) if (apart > 0).all() else apart.max())


def footprint(case: SceneCase) -> Footprint:
    """Return the footprint of the object."""
    return (*case.place[:2], *case.size[:2])


def neighbours(case: SceneCase) -> list[Footprint]:
    """Return what the object must not overlap: the bowl, and the outside of the table's edges.

    The outside of an edge is a rectangle of 10 m. A shelf has no edges here.
    """
    (length, width, _), (x, y) = TABLE
    round_bowl = (*case.bowl_at, 2 * bowl.RIM, 2 * bowl.RIM)
    if case.place[2]:
        return [round_bowl]
    along, across = 5 + length / 2, 5 + width / 2
    ends = [(x + side * along, y, 10.0, 10.0) for side in (-1, 1)]
    return [round_bowl, *ends, *((x, y + side * across, 10.0, 10.0) for side in (-1, 1))]


def margin(case: SceneCase) -> float:
    """Return the distance of the object from the bowl, or from an edge of its support [m]."""
    return min(gap(footprint(case), other) for other in neighbours(case))


def corners(case: SceneCase, centre: FloatArray) -> FloatArray:
    """Return the corners (n, 3) of an upright object, those of a cylinder as 64 in each circle."""
    around = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    square = [(-1, -1), (-1, 1), (1, -1), (1, 1)]
    plan = np.array(
        square if case.shape == "box" else np.column_stack([np.cos(around), np.sin(around)])
    )
    levels = [np.column_stack([plan, np.full(len(plan), side)]) for side in (-1.0, 1.0)]
    return np.asarray(centre) + np.vstack(levels) * np.array(case.size) / 2


def measured(run: Experiment, scene: str) -> dict[str, dict[str, float]]:
    """Return by rung the values that decide about a scene, by the names of `spec.LIMITS`."""
    rest = f"{scene}_at_rest"
    found = {
        group: {
            name.removeprefix(f"{scene}_"): value
            for name, value in run.readings[group].items()
            if name.startswith(f"{scene}_")
        }
        for group in ("object", "outline", "reach", "contacts", "pixels")
        if group in run.readings
    }
    ball = run.traces[rest].link_pos[-1, BALL]
    return values(run.cases[rest], (run.metrics[rest], run.metrics[scene]), ball, found)


def values(
    case: SceneCase,
    metrics: tuple[Any, Any],
    ball: FloatArray,
    found: Mapping[str, Mapping[str, float]],
) -> dict[str, dict[str, float]]:
    """Return by rung the values that decide about a scene.

    Args:
        case: its settings.
        metrics: `SceneMetrics` of the run at rest and of the lift.
        ball: (3,) where the ball ends [m].
        found: readings by group and name.
    """
    rest, lift = metrics
    inside = np.hypot(*(ball[:2] - case.bowl_at)) + case.ball_radius < bowl.RIM
    shown = found.get("pixels", found["outline"])
    best = max(CAMERAS, key=lambda name: shown[name])
    contacts, mass = found["contacts"], case.density * case.volume
    return {
        "built": {
            "margin": margin(case),
            "depth": found["object"]["depth"],
            "mass": abs(found["object"]["mass"] / mass - 1),
            "ball": rest.ball if inside else np.inf,
        },
        "stable": {"support": abs(rest.support), "drift": rest.drift, "moved": rest.moved},
        "seen": {
            "pixels": shown[best],
            "share": shown[best] / max(found["outline"][best], 1.0),
        },
        "reachable": {
            "accepted": found["reach"]["accepted"],
            "pregrasp": found["reach"]["pregrasp"],
            "grasp": found["reach"]["grasp"],
            "touches": found["reach"]["touches"],
        },
        "graspable": {
            "width": case.size[1],
            "descending": contacts["descending"],
            "fingers": min(
                contacts[f"{when}_{side}"]
                for when in ("closed", "held")
                for side in ("left", "right")
            ),
            "rise": lift.rise / lift.hand_rise,
        },
    }


def scenes(run: Experiment) -> list[str]:
    """Return the scenes of a page, in the order of the specification."""
    return [name for name in spec.SCENES if name in run.traces]


def passed(values: Mapping[str, float]) -> bool:
    """Return whether all values of a rung are within their limits."""
    return all(
        spec.LIMITS[name][0] <= value <= spec.LIMITS[name][1] for name, value in values.items()
    )


def verdicts(run: Experiment, scene: str) -> dict[str, bool]:
    """Return by rung whether a scene passes it."""
    return {rung: passed(values) for rung, values in measured(run, scene).items()}


def failed(run: Experiment, scene: str) -> list[str]:
    """Return the rungs that a scene fails."""
    return [rung for rung, good in verdicts(run, scene).items() if not good]
