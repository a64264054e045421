"""Specification of lesson L02: the dropped box, and what its runs are compared by.

It is data and computes nothing: what of it decides a measured value or a check is in
`parameters()`, and only a change there makes evidence stale.
"""

from dataclasses import asdict, replace
from typing import Any

from robo_genesis.core.scene import CAMERA, DT, SUBSTEPS
from robo_genesis.sim.rigid_bodies import Drop

LESSON = "l02"
MINIMUM_HARDWARE = "cpu"
STUDY_PAGE = "lecture"
"""The page of the lesson that runs the study of substeps."""

BASELINE = Drop(size=0.10, density=500.0, height=0.5, steps=20)
CASES = {"baseline": BASELINE}
"""The lab's one run."""

SUBSTEPS_STUDIED = (1, 2, 4, 10, 20)
SUBSTEP_CASES = {
    f"substeps_{n}": replace(BASELINE, substeps=n) for n in SUBSTEPS_STUDIED if n != SUBSTEPS
}
"""The solver's step is the one factor: each of these takes a scene of its own."""

LINK = "box_baselink"
"""The box's one link, as the engine names it."""

EXPECTED_MODEL = {"entities": 2, "links": 1, "geoms": 1, "joints": 1, "dofs": 6, "qpos": 7}
"""Of the scene (entities, the ground among them) and of the box."""

FORMULA_TOLERANCE = 1e-6
"""What position in float32 may differ from the exact sum by, at half a metre [m]."""

AT_REST = 1e-6
"""Sideways motion [m] and turning [rad/s] below this are none."""

VIEW = CAMERA | {"pos": (0.8, -0.8, 0.5), "lookat": (0.0, 0.0, 0.3), "fov": 40}
"""The lesson's camera: nearer than the robot's, with ground and box in the picture."""

RESOLUTION = {"m": 1e-6, "m/s": 1e-5, "rad/s": 1e-6, "s": DT / 2, "kg": 1e-6, "1": 0.5}
"""Differences below these are called equal, by unit."""

TOLERANCES = {
    "m": (2e-6, 0.0),
    "m/s": (2e-5, 0.0),
    "rad/s": (1e-6, 0.0),
    "s": (0.0, 0.0),
    "kg": (1e-6, 0.0),
}
"""By unit, (atol, rtol) that one metric may differ by between engine versions or backends."""

RELATIONS = ()
"""One run claims no ordering."""


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    return {
        "cases": {name: asdict(case) for name, case in CASES.items()},
        "expected_model": dict(EXPECTED_MODEL),
        "view": {name: value for name, value in VIEW.items() if name != "GUI"},
        "formula_tolerance_m": FORMULA_TOLERANCE,
        "at_rest": AT_REST,
    }


def study_parameters() -> dict[str, Any]:
    """Return those of the lecture, whose runs are more."""
    return parameters() | {"studies": {n: asdict(case) for n, case in SUBSTEP_CASES.items()}}
