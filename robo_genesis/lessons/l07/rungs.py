"""The ladder: what each rung measures of a scene, and whether the scene passes it."""

from collections.abc import Iterable, Mapping
from itertools import combinations

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.bodies.table import Footprint
from robo_genesis.sim.camera.geometry import project
from robo_genesis.sim.camera.views import View

from . import spec
from .spec import LIMITS

# Where each camera is.
CAMERAS = {"world": "beside the table", "wrist": "on the hand"}

# No rung, and the rungs, by the number with which a page asks for them.
NUMBERS = (None, *spec.RUNGS)


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
    shared = [
        (plan[a], plan[b])
        for a, b in combinations(boxes, 2)
        if min(boxes[a][1, 2], boxes[b][1, 2]) - max(boxes[a][0, 2], boxes[b][0, 2])
        > 1e-3
    ]
    edges = [
        (plan[name], (x + i * (5 + length / 2), y + k * (5 + width / 2), 10.0, 10.0))
        for name, below in (("bowl", "table"), ("object", [*boxes][-1]))
        for x, y, length, width in [plan[below]]
        for i, k in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    return shared + edges


def best(views: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Return pixels and share of the view whose worse one is best, in units of its bound."""
    pixels, share = (LIMITS[name][0] for name in ("pixels", "share"))
    return max(views, key=lambda of: min(of[0] / pixels, of[1] / share))


def measured(run: Experiment, scene: str) -> dict[str, dict[str, float]]:
    """Return by rung the values that decide about a scene, by the names of `spec.LIMITS`."""
    found = run.readings["ladder"]
    return {
        rung: {name: found[f"{scene}_{name}"] for name in names}
        for rung, names in spec.QUANTITIES.items()
    }


def scenes(run: Experiment) -> list[str]:
    """Return the scenes of a page, in the order of the specification."""
    return [name for name in spec.SCENES if name in run.traces]


def passed(values: Mapping[str, float]) -> bool:
    """Return whether all values of a rung are within their limits."""
    return all(
        LIMITS[name][0] <= value <= LIMITS[name][1] for name, value in values.items()
    )


def rung_of(quantity: str) -> str:
    """Return the rung that a quantity belongs to."""
    return next(of for of, names in spec.QUANTITIES.items() if quantity in names)


def failed(run: Experiment, scene: str) -> list[str]:
    """Return the rungs that a scene fails."""
    return [rung for rung, of in measured(run, scene).items() if not passed(of)]
