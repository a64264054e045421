"""The ladder: what each rung measures of a scene, and whether the scene passes it."""

from collections.abc import Iterable, Mapping
from itertools import combinations
from typing import Any, Protocol

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.free_fall import GRAVITY
from robo_genesis.sim.bodies.table import Footprint, SceneCase, gap
from robo_genesis.sim.camera.geometry import project
from robo_genesis.sim.camera.views import View

from . import spec
from .metrics import BALL
from .spec import LIMITS

# Where each camera is.
CAMERAS = {"world": "beside the table", "wrist": "on the hand"}

# No rung, and the rungs, by the number with which a page asks for them.
NUMBERS = (None, *spec.RUNGS)

# Names of the contact points of each finger in the counts of a lift.
FINGERS = ("closed_left", "closed_right", "held_left", "held_right")


def outline(corners: FloatArray, view: View, inside: bool = False) -> float:
    """Return the area of the picture of a convex body in a view, whole and not hidden [pixel].

    Args:
        corners: (n, 3) of the body [m].
        view: of a camera.
        inside: whether the area counts as 0 if the border of the picture cuts it. It
            always does if a corner is not before the camera.
    """
    from scipy.spatial import ConvexHull

    pixels = project(corners, view.intrinsics, view.transform)
    good = (pixels > 0) & (pixels < view.size) if inside else np.isfinite(pixels)
    return (
        float(ConvexHull(pixels).volume) if good.all() else 0.0
    )  # of two dimensions: the area


def pairs(boxes: Mapping[str, FloatArray]) -> list[tuple[Footprint, Footprint]]:
    """Return the footprints that must not overlap.

    They are those of two bodies that share more than 1 mm of height, and that of a body
    beside the outside of each edge of its support, a rectangle of 10 m.
    """
    plan = {
        name: (*of.mean(axis=0)[:2], *np.ptp(of, axis=0)[:2])
        for name, of in boxes.items()
    }
    found = [
        (plan[a], plan[b])
        for a, b in combinations(boxes, 2)
        if min(boxes[a][1, 2], boxes[b][1, 2])
        > max(boxes[a][0, 2], boxes[b][0, 2]) + 1e-3
    ]
    for name, below in {"bowl": "table", "object": [*boxes][-1]}.items():
        x, y, length, width = plan[below]
        for side in (-1, 1):
            along, across = x + side * (5 + length / 2), y + side * (5 + width / 2)
            found.append((plan[name], (along, y, 10.0, 10.0)))
            found.append((plan[name], (x, across, 10.0, 10.0)))
    return found


def margin(boxes: Mapping[str, FloatArray]) -> float:
    """Return the smallest distance of footprints that must not overlap [m]."""
    return min(gap(*pair) for pair in pairs(boxes))


class Observed(Protocol):
    """What was observed of a scene: metrics of both runs, the ball's end (3,) [m], readings."""

    case: SceneCase
    ball: FloatArray
    rested: Any
    lifted: Any

    def read(self, group: str) -> Mapping[str, float]:
        """Return a group of readings by name."""


def built(of: Observed) -> dict[str, float]:
    """Return how the geometry of the engine differs from the meant one, and where the ball is."""
    found, case = {**of.read("object")}, of.case
    found["mass"] = abs(found["mass"] / (case.density * case.volume) - 1)
    inside = np.hypot(*(of.ball[:2] - case.bowl_at)) + case.ball_radius < bowl.RIM
    del found["width"]
    return found | {"ball": of.rested.ball if inside else np.inf}


def stable(of: Observed) -> dict[str, float]:
    """Return what carries the object, and how it moves, with a push as well."""
    rest, found = of.rested, {**of.read("support")}
    found["carried"] /= of.read("object")["mass"] * GRAVITY
    motion = {"support": abs(rest.support), "drift": rest.drift, "moved": rest.moved}
    return found | motion


def seen(of: Observed) -> dict[str, float]:
    """Return pixels and share of the camera that is nearest to fulfilling both bounds."""
    outline = of.read("outline")
    shown = of.read("pixels") or outline
    views = [(shown[of], shown[of] / max(outline[of], 1.0)) for of in CAMERAS]
    return dict(zip(("pixels", "share"), best(views), strict=True))


def best(views: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Return pixels and share whose worse one is best, in units of its bound."""
    pixels, share = (LIMITS[name][0] for name in ("pixels", "share"))
    return max(views, key=lambda of: min(of[0] / pixels, of[1] / share))


def reachable(of: Observed) -> dict[str, float]:
    """Return the accepted answers, the clearances, and postures that touch something."""
    return {**of.read("reach")}


def graspable(of: Observed) -> dict[str, float]:
    """Return the width, what the hand touches, and the share of its rise."""
    contacts, lift = of.read("contacts"), of.lifted
    return {
        "width": of.read("object")["width"],
        "descending": contacts["descending"],
        "fingers": min(contacts[name] for name in FINGERS),
        "rise": lift.rise / lift.hand_rise,
    }


LADDER = {f.__name__: f for f in (built, stable, seen, reachable, graspable)}


class Recorded:
    """What a page recorded of a scene."""

    def __init__(self, run: Experiment, scene: str) -> None:
        rest = f"{scene}_at_rest"
        self.run, self.start = run, f"{scene}_"
        self.case, self.ball = run.cases[rest], run.traces[rest].link_pos[-1, BALL]
        self.rested, self.lifted = run.metrics[rest], run.metrics.get(scene)

    def read(self, group: str) -> dict[str, float]:
        """Return a group of readings by name."""
        found = self.run.readings.get(group, {})
        mine = [name for name in found if name.startswith(self.start)]
        return {name.removeprefix(self.start): found[name] for name in mine}


def measured(run: Experiment, scene: str) -> dict[str, dict[str, float]]:
    """Return by rung the values that decide about a scene, by the names of `spec.LIMITS`.

    An object that the hand cannot reach is not lifted.
    """
    found = Recorded(run, scene)
    asked = [*LADDER.items()][: None if found.lifted else -1]
    return {rung: values(found) for rung, values in asked}


def first_failure(of: Observed) -> tuple[int, dict[str, float]]:
    """Return the number of the first rung that fails, 0 for none, and all values up to it.

    Nothing is read for later rungs.
    """
    found: dict[str, float] = {}
    for number, values in enumerate(LADDER.values(), 1):
        found |= (mine := values(of))
        if not passed(mine):
            return number, found
    return 0, found


def scenes(run: Experiment) -> list[str]:
    """Return the scenes of a page, in the order of the specification."""
    return [name for name in spec.SCENES if f"{name}_at_rest" in run.traces]


def passed(values: Mapping[str, float]) -> bool:
    """Return whether all values of a rung are within their limits."""
    return all(
        LIMITS[name][0] <= value <= LIMITS[name][1]
        for name, value in values.items()
    )


def failed(run: Experiment, scene: str) -> list[str]:
    """Return the rungs that a scene fails."""
    return [rung for rung, values in measured(run, scene).items() if not passed(values)]
