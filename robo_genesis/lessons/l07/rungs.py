"""The ladder: what each rung measures of a scene, and whether the scene passes it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.table import SceneCase
from robo_genesis.sim.camera.geometry import project
from robo_genesis.sim.camera.views import View

from . import spec
from .metrics import BALL

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
    shown, contacts = found.get("pixels", found["outline"]), found["contacts"]
    best = max(CAMERAS, key=lambda name: shown[name])
    return {
        "built": {
            "margin": case.margin,
            "depth": found["object"]["depth"],
            "mass": abs(found["object"]["mass"] / (case.density * case.volume) - 1),
            "ball": rest.ball if inside else np.inf,
        },
        "stable": {
            "support": abs(rest.support),
            "drift": rest.drift,
            "moved": rest.moved,
        },
        "seen": {
            "pixels": shown[best],
            "share": shown[best] / max(found["outline"][best], 1.0),
        },
        "reachable": dict(found["reach"]),
        "graspable": {
            "width": case.size[1],
            "descending": contacts["descending"],
            "fingers": min(contacts[name] for name in FINGERS),
            "rise": lift.rise / lift.hand_rise,
        },
    }


def scenes(run: Experiment) -> list[str]:
    """Return the scenes of a page, in the order of the specification."""
    return [name for name in spec.SCENES if name in run.traces]


def passed(values: Mapping[str, float]) -> bool:
    """Return whether all values of a rung are within their limits."""
    return all(
        spec.LIMITS[name][0] <= value <= spec.LIMITS[name][1]
        for name, value in values.items()
    )


def failed(run: Experiment, scene: str) -> list[str]:
    """Return the rungs that a scene fails."""
    return [rung for rung, values in measured(run, scene).items() if not passed(values)]
