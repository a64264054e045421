"""Specification of lesson L03: bodies that land, slide and bounce, tolerances and claims.

The module is data and computes nothing. `parameters()` has the values that decide what
runs; only a change there makes evidence stale. All other values only judge.
`study_spec` has the other pages.

Source of the parameters of landing and sliding: the public course robo-genesis-101,
    lesson L03
(https://github.com/datawhalechina/robo-genesis-101), so that figures can be compared.
"""

import math
from dataclasses import replace
from typing import Any

from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import CAMERA
from robo_genesis.sim.bodies.contacts import SURFACE_SIZE, TOP, ContactCase
from robo_genesis.sim.bodies.rigid_bodies import MODEL_COUNTS

MEASURES = False

MINIMUM_HARDWARE = "cpu"
# The record's name of the only link; the engine's name depends on the shape
LINK = "body"

BASELINE = ContactCase(start=(0.0, 0.0, 1.0), duration=1.5)

# One dropped cube, named by dt in milliseconds and substeps; the baseline has 10 and 2.
LANDINGS = {
    "baseline": BASELINE,
    "dt10_sub1": replace(BASELINE, substeps=1),
    "dt20_sub2": replace(BASELINE, dt=0.02, substeps=2),
    "dt20_sub1": replace(BASELINE, dt=0.02, substeps=1),
}

PUSHED = ContactCase(
    start=(-0.6, -0.15, TOP + 0.04),
    duration=2.0,
    friction=0.10,
    surface_friction=0.50,
    speed=2.0,
    settle=0.30,
)
BESIDE = replace(PUSHED, start=(-0.6, 0.15, TOP + 0.04), friction=0.80)

# Two cubes of low and high own friction, side by side on two surfaces.
SLIDES = {
    "low_on_050": PUSHED,
    "high_on_050": BESIDE,
    "low_on_030": replace(PUSHED, surface_friction=0.30),
    "high_on_030": replace(BESIDE, surface_friction=0.30),
}

SPRING = (1.0, 0.01)  # Time constant [s] and damping ratio of a nearly undamped contact

DROPPED_BALL = ContactCase(
    start=(0.0, 0.0, TOP + 0.04 + 0.10), duration=2.0, shape="ball", spring=SPRING
)

# One ball on a nearly undamped contact, named by its number of substeps.
BOUNCES = {
    f"bounce_sub{n}": replace(DROPPED_BALL, substeps=n) for n in (1, 2, 4, 10, 20, 100)
}

# The runs of the lab.
CASES = LANDINGS | SLIDES | BOUNCES

# Words of a reader for runs: the steps of a landing, the frictions of a slide, the
# solver step.
LABELS = {
    "baseline": "two steps of 5 ms",
    "dt10_sub1": "one step of 10 ms",
    "dt20_sub2": "two steps of 10 ms",
    "dt20_sub1": "one step of 20 ms",
    **{
        f"{name}{cone}": f"cube {case.friction:g} on table {case.surface_friction:g}{words}"
        for name, case in SLIDES.items()
        for cone, words in (("", ""), ("_elliptic", ", elliptic cone"))
    },
    **{name: f"h = {1000 * case.h:g} ms" for name, case in BOUNCES.items()},
}

# A pair with equal solver steps and different outer steps.
EQUAL_STEP = ("dt10_sub1", "dt20_sub2")

# The only settings in which compared cases may differ.
ONE_FACTOR = {
    ("dt10_sub1", "baseline"): {"substeps"},
    ("dt20_sub1", "dt20_sub2"): {"substeps"},
    EQUAL_STEP: {"dt", "substeps"},
    ("low_on_050", "high_on_050"): {"friction", "start"},
    ("low_on_050", "low_on_030"): {"surface_friction"},
    ("high_on_050", "high_on_030"): {"surface_friction"},
    **{
        (name, "bounce_sub100"): {"substeps"}
        for name in BOUNCES
        if name != "bounce_sub100"
    },
}

EXPECTED_MODEL = MODEL_COUNTS

# Tolerances that only judge

SAME_STATE = 1e-6  # Of states at shared times where the solver steps are equal [m]
# Of a stopping distance where the friction of the pair did not change [m]
SAME_SLIDE = 1e-4
# Relative, of a stopping distance against Coulomb's: these cubes hop
COULOMB_SHARE = 0.20
# Of a reported depth against that of the positions [m]: corners differ
DEPTH_TOLERANCE = 1e-4

# Of the conserved energy in a flight, as a share of the energy at the start: float32
# rounds in each of up to some thousand solver steps. The bounded error of the total
# energy is at least ten times as large.
LEVEL_SHARE = 1e-4

# Of the share kept at the first bounce with the finest step, against a spring [%]
FINE_SHARE = 0.3
# With some coarser step, that share differs from a spring's by more [%]
COARSE_SHARE = 1.5

# The lesson's camera, close enough to show the cube large and its whole path.
VIEW = CAMERA | {"pos": (1.3, -1.5, 1.25), "lookat": (0.0, 0.0, 0.87), "fov": 16}

# By unit, the difference below which two values count as equal.
RESOLUTION = {
    "m": 1e-5,
    "m/s": 1e-3,
    "rad/s": 0.05,
    "s": 0.005,
    "kg": 1e-6,
    "1": 0.5,
    "J": 1e-6,
    "%": 0.1,
}

# By unit, metric or array, (atol, rtol) of one value between engines, backends or
# processors.
#
# After a hop, the contact points at the landing decide the further motion, and no
# engine is right. The metrics of that motion have wide tolerances; those of times and
# spin compare little more than the order of magnitude. Genesis and MuJoCo with equal
# settings differ by as much. Two processors differed in arrays by up to 0.4 mm, 43
# mm/s, 0.24 mm of depth, 0.0014 in a quaternion, and in one sample by all contact
# points. About ten times as much is allowed, and of contacts any.
TOLERANCES = {
    "m": (2e-5, 0.0),
    "m/s": (1e-3, 0.0),
    "s": (0.0, 0.0),
    "kg": (1e-6, 0.0),
    "J": (5e-6, 0.0),
    "%": (0.2, 0.0),
    "stop_distance": (0.01, 0.0),
    "final_distance": (0.01, 0.0),
    "stop_time": (0.08, 0.0),
    "airborne": (0.05, 0.0),
    "hop": (0.005, 0.0),
    "rad/s": (12.0, 0.0),
    "1": (0.0, 0.0),
    "link_pos_m": (0.004, 0.0),
    "link_vel_m_s": (0.4, 0.0),
    "link_quat_wxyz": (0.014, 0.0),
    "penetration_m": (0.003, 0.0),
    "contacts": (math.inf, 0.0),
}

# Claimed orderings: ((first, second), metric, order of the second to the first,
# margin).
RELATIONS = (
    (("low_on_050", "high_on_050"), "stop_distance", "lower", 0.05),
    (("low_on_050", "low_on_030"), "stop_distance", "higher", 0.05),
)


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    surface = {"size_m": SURFACE_SIZE, "top_m": TOP}
    return inputs(CASES, VIEW, counted=list(EXPECTED_MODEL), surface=surface)
