"""Specification of lesson L05: targets, solver settings, controllers, predictions and tolerances.

Pages, checks, verification and tests read the experiment here. The module is data and
computes nothing. `parameters()` has the values that decide what runs; all other values
only judge.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.experiment import case_inputs, inputs
from robo_genesis.core.scene import CAMERA, read_only
from robo_genesis.sim.arm import franka, reaching

from .run import ReachCase, SolveCase

MEASURES = False

MINIMUM_HARDWARE = "cpu"

# What lessons about reaches have alike, under the names of a specification.
IK, ONE_START, DOWN = reaching.IK, reaching.ONE_START, reaching.DOWN
BEYOND_REACH, MARKER_RADIUS = reaching.BEYOND_REACH, reaching.MARKER_RADIUS
RESOLUTION, REACHED = reaching.RESOLUTION, reaching.REACHED
SAME_POSE, SAME_RESIDUAL = reaching.SAME_POSE, reaching.SAME_RESIDUAL

EXPECTED_MODEL = franka.MODEL_COUNTS

# Lower and upper limits (7,) of the arm's joints in the model file [rad].
ARM_LIMITS = (
    read_only([-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973]),
    read_only([2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973]),
)

# Target of the hand's origin in the world [m].
TARGET = read_only((0.45, 0.0, 0.35))

BASELINE = ReachCase(TARGET, DOWN, IK, steps=180)
KP_DOUBLED = replace(BASELINE, kp=2 * franka.KP_BASELINE)
CASES = {
    "baseline": BASELINE,
    "kp_doubled": KP_DOUBLED,
    "gravity_compensated": replace(BASELINE, compensated=True),
    "kp_doubled_ramp": replace(KP_DOUBLED, ramp=100),
}

# The mark of each case in the palette.
CASE_MARKS = dict(zip(CASES, ("baseline", "first", "second", "third"), strict=True))

# Runs of the lecture with a smaller solver step.
FINE = 20
FINER = {
    f"{name}_fine": replace(CASES[name], substeps=FINE)
    for name in ("baseline", "kp_doubled", "kp_doubled_ramp")
}

# The runs that the lecture has beside those of the lab; the last one never needs its
# limits.
MORE = FINER | {"unlimited": replace(KP_DOUBLED, effort_limit=10 * franka.EFFORT_LIMIT)}

# Words of a reader for runs.
LABELS = {
    name: name.replace("kp", "KP").replace("_ramp", ", ramp").replace("_", " ")
    for name in CASES
}
LABELS |= {f"{name}_fine": f"{LABELS[name]}, {FINE} substeps" for name in CASES}
LABELS["unlimited"] = "KP doubled, ten times the force limits"

VIEWED = "world"  # The recorded view of the camera, before the first step

FOV = 42.0  # Vertical field of view of the lesson's camera [degree]

# The lesson's camera: the robot, the marker and the ground.
VIEW = CAMERA | {
    "pos": (1.5, -1.1, 1.0),
    "lookat": (0.4, 0.0, 0.3),
    "fov": FOV,
    "near": 0.1,
    "far": 20.0,
}

# Near and far limit of the view `cut` [m]: one is inside the hand, the other on the
# floor.
CUT = (1.65, 2.2)

HAND_FOV = 60.0  # Vertical field of view of the camera on the hand [degree]

# The camera in the frame of the hand, z backwards: it looks along the fingers [m].
ON_HAND = ((0.0, -1, 0, 0.05), (-1, 0, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1))

# The views of the page about cameras, and what the cameras are given, or have by
# default.
VIEWS: dict[str, dict[str, Any]] = {
    VIEWED: VIEW,
    "cut": VIEW | {"near": CUT[0], "far": CUT[1]},
    "hand": {"fov": HAND_FOV, "near": 0.1, "far": 20.0},
}

# What is looked up in the segmentation.
SEGMENTS = ("plane", "hand", "marker")

# How the second case of a pair compares with the first [m]; not fitted to a run.
RELATIONS = (
    (("baseline", "kp_doubled"), "final_distance", "lower", 1e-3),
    (("baseline", "gravity_compensated"), "final_distance", "lower", 1e-3),
    (("baseline", "kp_doubled"), "overshoot", "higher", 1e-3),
    (("kp_doubled", "kp_doubled_ramp"), "overshoot", "lower", 1e-3),
)

GRID_X, GRID_Y, GRID_Z = (
    tuple(np.round(np.linspace(*ends), 3).tolist())
    for ends in ((0.1, 0.9, 9), (-0.6, 0.6, 7), (0.05, 0.95, 7))
)
# Height of the horizontal plane of the reach map [m]; the vertical plane is y = 0
HEIGHT = 0.35

# Targets (63, 3) of the reach map, row by row [m].
PLANES = {
    "vertical": read_only([(x, 0.0, z) for z in GRID_Z for x in GRID_X]),
    "horizontal": read_only([(x, y, HEIGHT) for y in GRID_Y for x in GRID_X]),
}

REACH_MAP = {
    name: SolveCase(points, DOWN, np.tile(franka.Q_START, (len(points), 1)), ONE_START)
    for name, points in PLANES.items()
}

RESTARTS = 100

# Starts (100, 9) of the solver, uniform within the limits [rad or m].
RANDOM_STARTS = np.hstack(
    [
        np.random.default_rng(0).uniform(*ARM_LIMITS, (RESTARTS, 7)),
        np.tile(franka.Q_START[7:], (RESTARTS, 1)),
    ]
)

# Joint positions (7,) of an arm whose Jacobian has a small singular value [rad].
NEARLY_STRETCHED = read_only((0.0, 0.0, 0.0, -0.07, 0.0, 1.6, 0.0))

# A target that the solver reaches with the fingertips below the floor.
IN_THE_FLOOR = replace(BASELINE, position=read_only((0.5, 0.0, 0.05)))

# The lesson's question with smaller tolerances of the position.
PRECISE = {
    f"at_{name}": replace(
        BASELINE, settings=replace(ONE_START, position_tolerance=most)
    )
    for name, most in (
        ("500_um", 5e-4),
        ("50_um", 5e-5),
        ("5_um", 5e-6),
        ("500_nm", 5e-7),
    )
}

MANY_STARTS = SolveCase(np.tile(TARGET, (RESTARTS, 1)), DOWN, RANDOM_STARTS, ONE_START)

DRAWS = 20

# The target beyond reach from the lesson's start, then from 19 random ones.
UNREACHABLE = SolveCase(
    np.tile(BEYOND_REACH, (DRAWS, 1)),
    DOWN,
    np.vstack([franka.Q_START, RANDOM_STARTS[1:DRAWS]]),
    IK,
)

# Questions to the solver beyond those of the lab.
QUESTIONS = REACH_MAP | {
    "vertical_restarted": replace(REACH_MAP["vertical"], settings=IK),
    "many_starts": MANY_STARTS,
    "unreachable": UNREACHABLE,
}

# As in `reaching`. The answers to these questions have no bound: rounding decides which
# of many postures a search finds.
TOLERANCES = reaching.TOLERANCES | {"iterations": (0.0, 0.0)}
TOLERANCES |= dict.fromkeys(QUESTIONS, (math.inf, 0.0))

# Share of the displacement that gravity, KP and the Jacobian may leave unexplained.
SAG_SHARE = 0.02

# Metres that count as much as one radian, where the nearest pose is sought
ANGLE_WEIGHT = 0.5

# The engine's answer for the target beyond reach is farther than the nearest pose by
# more [m].
BEYOND_NEAREST = 1e-3


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    asked = case_inputs(PRECISE | {"in_the_floor": IN_THE_FLOOR})
    asked["stretched"] = NEARLY_STRETCHED.tolist()
    counted = list(EXPECTED_MODEL)
    return inputs(CASES, VIEW, asked=asked, counted=counted, marker=MARKER_RADIUS)


def lecture_parameters() -> dict[str, Any]:
    """Return the inputs of the lecture, which has more runs than the lab."""
    return parameters() | {"further": case_inputs(MORE)}


def solution_parameters() -> dict[str, Any]:
    """Return the further inputs of the page about many solutions."""
    return {"questions": case_inputs(QUESTIONS)}


def view_parameters() -> dict[str, Any]:
    """Return the inputs of the page about cameras."""
    return parameters() | {"cut": CUT, "hand_fov": HAND_FOV, "on_hand": ON_HAND}
