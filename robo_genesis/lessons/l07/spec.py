"""Specification of lesson L07: table scenes of which each fails one rung, limits and tolerances.

Pages, checks, verification and tests read the experiment here. The module is data and
computes nothing. `parameters()` has the values that decide what runs; all other values
only judge.
"""

from dataclasses import asdict, replace
from typing import Any

import numpy as np

from robo_genesis.core import check_spec
from robo_genesis.core.experiment import inputs, json_value
from robo_genesis.core.scene import CAMERA, DT
from robo_genesis.sim.arm import franka, lifting, reaching
from robo_genesis.sim.bodies import table
from robo_genesis.sim.bodies.table import SceneCase

from . import bowls, rest

MEASURES = False

MINIMUM_HARDWARE = "cpu"

EXPECTED_MODEL = franka.MODEL_COUNTS

# Settings of the solver, and the orientation of the hand.
ONE_START, DOWN = reaching.ONE_START, reaching.DOWN

# Outer steps of a scene at rest, and of a lift.
RESTING, LIFTING = 60, lifting.ENDS["hold"]

GOOD = SceneCase(
    shape="cylinder",
    size=(0.05, 0.05, 0.07),
    place=(0.5, -0.05, 0.0),
    kp=lifting.KP,
    kv=lifting.KV,
    steps=RESTING,
)

# The scene that passes all rungs, and five that fail one each.
SCENES = {
    "baseline": GOOD,
    "hovering": replace(GOOD, gap=0.005, weightless=True),
    "filled": replace(GOOD, bowl="one_hull"),
    "outside": replace(GOOD, place=(0.15, 0.33, 0.0), fov=24.0),
    "below": replace(GOOD, place=(0.45, -0.46, -0.3)),
    "wide": replace(GOOD, shape="box", size=(0.05, 0.082, 0.06)),
}

# What readers call the scenes, so that a name does not answer a question.
LETTERS = dict(zip(SCENES, "ABCDEF", strict=True))

# Words of a reader for runs.
LABELS = {name: f"scene {letter}" for name, letter in LETTERS.items()}
LABELS |= {
    f"{name}_at_rest": f"scene {letter} at rest" for name, letter in LETTERS.items()
}
LABELS |= rest.LABELS | {"in_one_hull": "one hull", "in_default": "several hulls"}
LABELS |= {"forced": "two solver steps", "forced_fine": "four solver steps"}

# The mark of each case in the palette.
CASE_MARKS = {"baseline": "baseline", "hovering": "first"}
CASE_MARKS |= {"forced": "second", "forced_fine": "third"}

# The lifts that are compared, with words for their objects.
SHOWN_LIFTS = {
    "baseline": "50 mm",
    "wide": "82 mm",
    "forced": "80.5 mm, µ 0.1",
    "forced_fine": "80.5 mm, µ 0.1, half the step",
}

RUNGS = ("built", "stable", "seen", "reachable", "graspable")

# The one rung that each scene fails; not fitted to a run.
FAILS = dict(
    zip(
        SCENES, (None, "stable", "built", "seen", "reachable", "graspable"), strict=True
    )
)


# A slippery box that is half a millimetre wider than the opening
FORCED = replace(SCENES["wide"], size=(0.05, 0.0805, 0.06), friction=0.1, pads=0.1)
SCENES_OF_LECTURE = ("baseline", "hovering", "filled", "wide")


# Where all lifts begin: a fault of an object's own place cannot fail them [m].
SPOT = (0.55, 0.0, 0.0)


def lift_of(scene: SceneCase, **changed: Any) -> SceneCase:
    """Return the run that lifts the object of a scene from the spot."""
    return replace(scene, place=SPOT, steps=LIFTING, **changed)


def runs(*scenes: str) -> dict[str, SceneCase]:
    """Return both runs of scenes: the lift has the name of the scene, the other one `_at_rest`."""
    lifts = {name: lift_of(SCENES[name]) for name in scenes}
    return lifts | {f"{name}_at_rest": SCENES[name] for name in scenes}


# The slippery box, at two solver steps.
FURTHER = {"forced": lift_of(FORCED), "forced_fine": lift_of(FORCED, substeps=4)}

CASES = runs(*SCENES) | FURTHER

# The camera in the world; `fov` is that of the scene.
VIEW = CAMERA | {
    "pos": (1.05, -0.4, 1.0),
    "lookat": (0.45, 0.0, 0.0),
    "near": 0.1,
    "far": 20.0,
}

# The camera on the hand. With the default near limit, 0.1 m, it would cut a held object
# open.
WRIST = {"res": CAMERA["res"], "fov": 60, "near": 0.01, "far": 20.0, "GUI": False}

# Least and largest value that passes, by quantity: [m], shares, pixels or counts.
LIMITS: dict[str, tuple[float, float]] = {
    "margin": (5e-3, np.inf),
    "depth": (0, 1e-3),
    "mass": (0, 0.01),
    "ball": (0, 0.025),
    "support": (0, 5e-4),
    "drift": (0, 2e-3),
    "moved": (0, 2e-4),
    "pixels": (200, np.inf),
    "share": (0.5, np.inf),
    "accepted": (2, 2),
    "pregrasp": (0.03, np.inf),
    "grasp": (0.02, np.inf),
    "touches": (0, 0),
    "width": (0, 0.076),
    "descending": (0, 0),
    "fingers": (1, np.inf),
    "rise": (0.8, np.inf),
}

RESOLUTION = rest.RESOLUTION | {"s": DT / 2, "1": 0.5}

# Contacts make rounding grow, so lifts have wide tolerances. The answers on the map of
# the table have no bound: rounding decides which of many postures a search finds.
TOLERANCES = (
    check_spec.TOLERANCES
    | bowls.TOLERANCES
    | rest.TOLERANCES
    | {
        "pixels": (20.0, 0.01),
        "steps": (20.0, 0.0),
        "points": (4.0, 0.0),
        "poses": (0.0, 0.0),
        "postures": (3.0, 0.0),
    }
    | dict.fromkeys((*SCENES, *FURTHER), (0.5, 0.1))
    | {"table": (np.inf, 0.0)}
)

# How the second case of a pair compares with the first [m]; not fitted to a run.
RELATIONS = ((("forced", "forced_fine"), "rise", "equal", 5e-3),)


def parameters(cases: dict[str, Any]) -> dict[str, Any]:
    """Return every configured input of a page with these runs as JSON values, for its key."""
    of_scene = ("TABLE", "FLOOR", "ON_HAND", "BALL_HEIGHT")
    of_lift = ("PHASES", "PAD", "HAND_TO_PAD", "ABOVE", "RISE")
    further = {name: getattr(table, name) for name in of_scene}
    further |= {name: getattr(lifting, name) for name in of_lift}
    further |= {"settings": asdict(ONE_START)}
    wrist = {name: value for name, value in WRIST.items() if name != "GUI"}
    return inputs(
        cases,
        VIEW,
        table=json_value(further),
        wrist=wrist,
        counted=list(EXPECTED_MODEL),
    )
