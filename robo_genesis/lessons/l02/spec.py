"""Specification of lesson L02: the dropped box, its expected values and its tolerances.

The module is data and computes nothing. `parameters()` has the values that decide what
runs and what is read; only a change there makes evidence stale. All other values only
judge.
"""

from dataclasses import replace
from typing import Any

from robo_genesis.core.check_spec import FALL_TOLERANCES
from robo_genesis.core.experiment import case_inputs, inputs
from robo_genesis.core.scene import CAMERA, DT, SUBSTEPS
from robo_genesis.sim.bodies.rigid_bodies import MODEL_COUNTS, Drop

MEASURES = False

MINIMUM_HARDWARE = "cpu"

BASELINE = Drop(size=0.10, density=500.0, height=0.5, steps=20)

# The run of the lab.
CASES = {"baseline": BASELINE}

SUBSTEPS_STUDIED = (1, 2, 4, 10, 20)

# These cases differ from the baseline in the solver step alone; each needs its own
# scene.
SUBSTEP_CASES = {
    f"substeps_{n}": replace(BASELINE, substeps=n)
    for n in SUBSTEPS_STUDIED
    if n != SUBSTEPS
}

# Words of a reader for runs: number and length of the solver steps in an outer step.
LABELS = {
    name: f"{case.substeps} substep{'s' * (case.substeps > 1)} of {1000 * case.h:g} ms"
    for name, case in (CASES | SUBSTEP_CASES).items()
}

LINK = "box_baselink"  # The engine's name of the box's only link

EXPECTED_MODEL = MODEL_COUNTS

# Tolerance of a float32 position of half a metre against the exact sum [m].
FORMULA_TOLERANCE = 1e-6

# Sideways motion [m], angular speed [rad/s] and a change of the unit quaternion up to
# this value count as zero.
AT_REST = 1e-6

# Tolerance of a speed against g t, as a share of the last speed: float32
SPEED_SHARE = 1e-5

# Relative tolerance of a measured gap against g h t / 2: at the smallest step the gap
# is small and the rounding of float32 shows.
FIRST_ORDER_SHARE = 0.02

BEFORE, AFTER = "before build", "after build"

# The side on which the engine accepts each call; on the other side it must refuse it.
BELONGS = {
    "scene.add_entity": BEFORE,
    "scene.add_camera": BEFORE,
    "scene.build": BEFORE,
    "scene.step": AFTER,
    "scene.reset": AFTER,
    "entity.get_pos": AFTER,
    "entity.set_pos": AFTER,
    "camera.render": AFTER,
}

# The lesson's camera: closer than the robot's, with ground and box in the picture.
VIEW = CAMERA | {"pos": (0.65, -0.65, 0.45), "lookat": (0.0, 0.0, 0.32), "fov": 36}

# Height of a tray's rim and radius of the ball that falls into it [m]. The tray's mesh
# is 0.15 m high, and its URDF file places it 5 mm lower.
RIM, BALL = 0.145, 0.03

RESTING = 2e-3  # How far a body at rest may be from where it just touches [m]

TRAYS = "trays"  # The camera frame of both trays

# Tolerance of a further fall against the exact sum: float32 heights of up to a metre
# [m].
FURTHER_TOLERANCE = 1e-6

# The further falls: start height [m], upward speed [m/s], factor of the mass, gravity
# [m/s²].
HIGHER, THROWN, HEAVIER, MOON = 1.0, 1.0, 4.0, 1.62

# The entities whose visual and collision geometry is counted.
SHAPES = ("box", "duck", "tray", "hammer")

# Triangles that are drawn or collide, and geoms that collide.
COUNTS = [f"{name}_{what}" for name in SHAPES for what in ("seen", "felt", "pieces")]

# By unit, the difference below which two values count as equal.
RESOLUTION = {"m": 1e-6, "m/s": 1e-5, "rad/s": 1e-6, "s": DT / 2, "kg": 1e-6, "1": 0.5}

TOLERANCES = FALL_TOLERANCES

# A single run claims no ordering.
RELATIONS = ()


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    return inputs(CASES, VIEW, counted=list(EXPECTED_MODEL))


def study_parameters() -> dict[str, Any]:
    """Return the inputs of the lecture, which has more runs."""
    return parameters() | {
        "studies": case_inputs(SUBSTEP_CASES),
        "calls": list(BELONGS),
        "shapes": list(SHAPES),
        "trays": {"rim": RIM, "ball": BALL},
        "further": {
            "height": HIGHER,
            "speed": THROWN,
            "mass": HEAVIER,
            "gravity": MOON,
        },
    }
