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
    "wide": replace(
        GOOD, shape="box", size=(0.05, 0.082, 0.06), place=(0.55, 0.0, 0.0)
    ),
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
    "forced": "80.5 mm",
    "forced_fine": "80.5 mm, half the step",
}

# The one rung that each scene fails; not fitted to a run.
FAILS = dict(
    zip(
        SCENES, (None, "stable", "built", "seen", "reachable", "graspable"), strict=True
    )
)


# A slippery box that is half a millimetre wider than the opening
FORCED = replace(SCENES["wide"], size=(0.05, 0.0805, 0.06), friction=0.1, pads=0.1)
SCENES_OF_LECTURE = ("baseline", "hovering", "filled", "wide")


def lift_of(scene: SceneCase, **changed: Any) -> SceneCase:
    """Return the run that lifts the object of a scene from its place."""
    return replace(scene, steps=LIFTING, **changed)


def runs(*scenes: str) -> dict[str, SceneCase]:
    """Return both runs of scenes: the lift has the name of the scene, the other one `_at_rest`."""
    lifts = {name: lift_of(SCENES[name]) for name in scenes}
    return lifts | {f"{name}_at_rest": SCENES[name] for name in scenes}


# The slippery box, at two solver steps.
FURTHER = {"forced": lift_of(FORCED), "forced_fine": lift_of(FORCED, substeps=4)}

# Counts of a lift, as `lifting.contact_counter` names them.
CONTACTS = ("descending", "closed_left", "closed_right", "held_left", "held_right")

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

# By rung and quantity: unit, least and largest value that passes. Shares have the unit 1.
QUANTITIES: dict[str, dict[str, tuple[str, float, float]]] = {
    "built": {
        "margin": ("m", 5e-3, np.inf),
        "shape": ("m", 0, 1e-3),
        "open": ("1", 0, 0),
        "friction": ("1", 0, 0.01),
        "mass": ("1", 0, 0.01),
        "depth": ("m", 0, 1e-3),
        "ball": ("m", 2e-3, 0.025),
    },
    "stable": {
        "carried": ("1", 0.95, 1.05),
        "support": ("m", 0, 5e-4),
        "drift": ("m", 0, 2e-3),
        "moved": ("m", 0, 2e-4),
        "pushed": ("m", 0, 2e-3),
        "reset": ("m", 0, 1e-6),
    },
    "seen": {"pixels": ("pixels", 200, np.inf), "share": ("1", 0.5, np.inf)},
    "reachable": {
        "accepted": ("poses", 3, 3),
        "pregrasp": ("m", 0.03, np.inf),
        "grasp": ("m", 0.02, np.inf),
        "over": ("m", 0.02, np.inf),
        "touches": ("postures", 0, 0),
    },
    "graspable": {
        "width": ("m", 0, 0.076),
        "descending": ("steps", 0, 0),
        "fingers": ("points", 1, np.inf),
        "rise": ("1", 0.8, np.inf),
    },
}

RUNGS = (*QUANTITIES,)
UNITS = {name: of[0] for rung in QUANTITIES.values() for name, of in rung.items()}
LIMITS = {name: of[1:] for rung in QUANTITIES.values() for name, of in rung.items()}

# A thinner ball sinks through the floor of the bowl: v T / e of its fall, and more [m].
THIN = 0.005

# The push of the rung "stable": gravity leans by this angle [rad].
PUSH = np.radians(10)

# Scenes that were made to fool a ladder, and good ones: by scene and what misleads, how it
# differs from the good scene, and the quantity that must catch it, none for a good one.
ATTACKS: dict[str, tuple[dict[str, Any], str | None]] = {
    "no weight, no gap: nothing moves": ({"weightless": True}, "carried"),
    "no weight, 0.4 mm gap: a small gap": (
        {"weightless": True, "gap": 4e-4},
        "carried",
    ),
    "bowl beside the table: a free object": ({"bowl_at": (1.35, 0.3)}, "margin"),
    "bowl over the edge: it is fixed": ({"bowl_at": (0.55, 0.4)}, "margin"),
    "bowl far away: an object within reach": ({"bowl_at": (0.95, 0.32)}, "accepted"),
    "µ = 0.01: the table's 0.8 acts": ({"friction": 0.01}, "friction"),
    "65 mm inside the table: it falls through": ({"gap": -0.065}, "margin"),
    "beside the bowl: postures exist": ({"place": (0.55, 0.11, 0.0)}, "touches"),
    "good, on a shelf: a lift elsewhere fails": ({"place": (0.5, -0.05, 0.1)}, None),
    "shelf in the bowl: a free object": ({"place": (0.5, 0.12, 0.055)}, "margin"),
    "pencil on its end: at rest": ({"size": (0.006, 0.006, 0.15)}, "pushed"),
    "flat, on a shelf: high above the table": (
        {"place": (0.5, -0.05, 0.1), "size": (0.05, 0.05, 0.037)},
        "grasp",
    ),
    "good, 60 × 200 mm: one camera is enough": ({"size": (0.06, 0.06, 0.2)}, None),
}

RESOLUTION = rest.RESOLUTION | {"s": DT / 2, "1": 0.5, "rad": 1e-3}

# Contacts make rounding grow, so lifts have wide tolerances. The answers on the map of
# the table have no bound: rounding decides which of many postures a search finds.
TOLERANCES = (
    check_spec.TOLERANCES
    | bowls.TOLERANCES
    | rest.TOLERANCES
    | {
        "pixels": (20.0, 0.01),
        "steps": (20.0, 0.0),
    }
    | dict.fromkeys((*SCENES, *FURTHER), (0.5, 0.1))
    | {"table": (np.inf, 0.0), "ladder": (0.02, 0.05), "caught": (0.02, 0.05)}
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
