"""Specification of lesson L01: a sphere that falls, and what a start of the engine needs.

The module is data and computes nothing. `parameters()` has the values that decide what
runs.
"""

from typing import Any

from robo_genesis.core.check_spec import FALL_TOLERANCES
from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import CAMERA, DT
from robo_genesis.sim.bodies.rigid_bodies import MODEL_COUNTS, Drop

MEASURES = False

MINIMUM_HARDWARE = "cpu"

RADIUS = 0.08  # Radius of the sphere [m]

# The fall; `size` is the diameter of the sphere.
BASELINE = Drop(size=2 * RADIUS, density=500.0, height=0.5, steps=20)

CASES = {"baseline": BASELINE}

ASKED_STEPS = 15  # Outer steps after which the lab asks for the height

LINK = "sphere_baselink"  # The engine's name of the sphere's only link

EXPECTED_MODEL = MODEL_COUNTS

# Tolerance of a float32 position of half a metre against the exact sum [m].
FORMULA_TOLERANCE = 1e-6

# The lesson's camera: ground and sphere are in the picture.
VIEW = CAMERA | {"pos": (0.75, -0.75, 0.5), "lookat": (0.0, 0.0, 0.32), "fov": 36}

# By unit, the difference below which two values count as equal.
RESOLUTION = {"m": 1e-6, "s": DT / 2, "1": 0.5}

TOLERANCES = FALL_TOLERANCES

# A single run claims no ordering.
RELATIONS = ()


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    return inputs(CASES, VIEW, counted=list(EXPECTED_MODEL))
