"""Specification of lesson L06: environments, their targets, gains and loads, and tolerances.

Pages, checks, verification and tests read the experiment here. The module is data and
computes nothing. `parameters()` has the values that decide what runs; all other values
only judge.
"""

from dataclasses import asdict, replace
from itertools import product
from typing import Any

from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import CAMERA, read_only
from robo_genesis.sim.arm import franka, reaching

from .run import Environment

MEASURES = False

MINIMUM_HARDWARE = "cpu"

# What lessons about reaches have alike, under the names of a specification.
IK, ONE_START, DOWN = reaching.IK, reaching.ONE_START, reaching.DOWN
BEYOND_REACH, MARKER_RADIUS = reaching.BEYOND_REACH, reaching.MARKER_RADIUS
RESOLUTION, REACHED = reaching.RESOLUTION, reaching.REACHED

# As in `reaching`. A robot with little damping still swings at the end of the sweep;
# between two processors it was up to 24 mm elsewhere.
TOLERANCES = reaching.TOLERANCES | {"sweep_end": (0.1, 0.0)}
SAME_POSE, SAME_RESIDUAL = reaching.SAME_POSE, reaching.SAME_RESIDUAL

EXPECTED_MODEL = franka.MODEL_COUNTS

HAND_MASS = 0.73  # Mass of the hand in the model file [kg]

# First target of the hand in each environment [m].
TARGETS = read_only(
    [(0.42, -0.12, 0.35), (0.48, -0.04, 0.4), (0.48, 0.06, 0.32), (0.4, 0.14, 0.38)]
)

# Second target of the hand in some environments [m].
LATER = {1: [(0.44, -0.16, 0.32)], 3: [(0.50, 0.12, 0.40)]}

# Outer steps until the second command, and of the whole run.
SWITCH, STEPS = 180, 360

RESET_AFTER = 30  # Outer steps until the partial reset, while all arms are moving

# Targets of which one is refused [m].
REFUSED = 2  # The row of `MIXED` that is beyond reach
MIXED = read_only([TARGETS[0], TARGETS[1], BEYOND_REACH, TARGETS[3]])

FIRST = Environment(TARGETS[:1], DOWN, IK, SWITCH, steps=STEPS)

# Numbers of the environments.
ENVS = tuple(range(len(TARGETS)))

WORLDS = {
    f"env_{k}": replace(FIRST, positions=read_only([TARGETS[k], *LATER.get(k, [])]))
    for k in ENVS
}

# The same worlds, each in a scene with one robot and without environments.
ALONE = {f"alone_{k}": WORLDS[f"env_{k}"] for k in ENVS}

SHORT = replace(FIRST, steps=SWITCH)

# One target, and four robots that differ in gains, mass of the hand or limits of the
# torques.
VARIANTS = {
    "plain_robot": SHORT,
    "stiff_robot": replace(SHORT, kp=2 * franka.KP_BASELINE),
    "loaded_robot": replace(SHORT, load=1.0),
    "unlimited_robot": replace(
        SHORT, kp=2 * franka.KP_BASELINE, effort_limit=20 * franka.EFFORT_LIMIT
    ),
}

# By which the sweep multiplies all KP, and all KV.
FACTORS = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)

# Masses that the sweep adds to the hand [kg].
LOADS = (0.0, 0.5, 1.0, 2.0)

# Names of the sweep's robots by both factors and load, in the order of their rows.
SWEEP = {
    (kp, kv, load): f"kp_{kp:g}_kv_{kv:g}_load_{load:g}".replace(".", "_")
    for kp, kv, load in product(FACTORS, FACTORS, LOADS)
}

# The robots of `VARIANTS` that are also in the sweep.
SWEPT = {"plain_robot": (1.0, 1.0, 0.0), "stiff_robot": (2.0, 1.0, 0.0)}
SWEPT |= {"loaded_robot": (1.0, 1.0, 1.0)}

CASES = WORLDS | ALONE | VARIANTS

INTO_THE_FLOOR = replace(
    FIRST, settings=replace(IK, clearance=-0.1), switch=STEPS, steps=STEPS
)

# Targets of the hand that put its fingers into the floor; the solver does not know the
# floor.
PRESSED = {
    f"pressed_{k}": replace(INTO_THE_FLOOR, positions=read_only([[x, y, 0.05]]))
    for k, (x, y, _) in enumerate(TARGETS)
}

# A target that the solver does not reach from the start, and reaches from random starts
# [m].
RESTARTED = read_only([(0.25, 0.0, 0.2)])

# Row k of the permuted batch is the world of this environment.
ORDER = (2, 0, 3, 1)

PERMUTED = {f"permuted_{k}": WORLDS[f"env_{k}"] for k in ENVS}

# Environments that are not touched while their neighbours are reset and commanded.
BESIDE = {
    f"beside_{k}": replace(WORLDS[f"env_{k}"], steps=RESET_AFTER + SWITCH)
    for k in ENVS
    if k not in LATER
}

# Environments from their partial reset on.
AGAIN = {
    f"again_{k}": replace(FIRST, positions=TARGETS[[k]], steps=SWITCH) for k in LATER
}

# Runs that must repeat another one; they are recorded, and have no metrics.
COPIES = PERMUTED | BESIDE | AGAIN

MARKS = ("baseline", "first", "second", "third")

# The mark of each case in the palette.
CASE_MARKS = {
    name: mark
    for group in (WORLDS, VARIANTS)
    for name, mark in zip(group, MARKS, strict=True)
}

# Words of a reader for runs.
LABELS = (
    {name: name.replace("env_", "environment ") for name in WORLDS}
    | {
        "plain_robot": "plain robot",
        "stiff_robot": "KP doubled",
        "loaded_robot": "1 kg in the hand",
        "unlimited_robot": "KP doubled, limits × 20",
    }
    | {name: f"environment {name[-1]} alone" for name in ALONE}
)

# Distance of neighbouring environments in pictures [m]; no state depends on it
SPACING = 1.0

# Where the replay draws the environments [m]: from left to right, none hides another.
PLACES = ((-0.81, -0.75), (-0.54, 0.09), (0.34, -0.09), (0.61, 0.75))

# The engine places it in the world of environment 0, which pictures show at a corner of
# the group. The lesson's camera: all environments, side by side.
VIEW = CAMERA | {"pos": (3.1, -1.7, 1.7), "lookat": (0.7, 0.45, 0.3), "fov": 32}

# How the second case of a pair compares with the first [m]; not fitted to a run.
RELATIONS = (
    (("plain_robot", "stiff_robot"), "final_distance", "lower", 1e-3),
    (("plain_robot", "loaded_robot"), "final_distance", "higher", 5e-4),
    (("plain_robot", "stiff_robot"), "overshoot", "higher", 5e-3),
    (("stiff_robot", "unlimited_robot"), "overshoot", "lower", 5e-3),
)

# Both are computed in float32. Largest difference of a row from the same run alone [rad
# or m, rad/s or m/s, N·m or N].
SAME_RUN = {"q": 5e-6, "qd": 5e-5, "control_force": 2e-2}

# Largest difference of a torque at rest from gravity and load, and from KP times error
# [N·m].
HELD = 0.05


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    return inputs(
        CASES | COPIES | PRESSED,
        VIEW,
        order=list(ORDER),
        hand_mass=HAND_MASS,
        mixed={"targets": MIXED.tolist(), "settings": asdict(ONE_START)},
        sweep={"factors": list(FACTORS), "loads": list(LOADS)},
        restarted=RESTARTED.tolist(),
        reset_after=RESET_AFTER,
        spacing=SPACING,
        counted=list(EXPECTED_MODEL),
    )
