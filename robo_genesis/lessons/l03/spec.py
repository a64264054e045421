"""Specification of lesson L03: bodies that land, slide and bounce, tolerances and claims.

The module is data and computes nothing. `parameters()` and `study_parameters()` have the values
that decide what runs and what is compared; only a change there makes evidence stale. All other
values only judge.

Source of the parameters of landing and sliding: the public course robo-genesis-101, lesson L03
(https://github.com/datawhalechina/robo-genesis-101), so that figures can be compared.
"""

from dataclasses import asdict, replace
from typing import Any

from robo_genesis.core.scene import CAMERA
from robo_genesis.sim.contacts import SURFACE_SIZE, TOP, ContactCase

MINIMUM_HARDWARE = "cpu"
STUDY_PAGE = "lecture"
"""The page of the lesson that runs the studies."""

LINK = "body"
"""The record's name of the only link of each run; the engine's name depends on the shape."""

BASELINE = ContactCase(start=(0.0, 0.0, 1.0), duration=1.5)
LANDINGS = {
    "baseline": BASELINE,
    "dt10_sub1": replace(BASELINE, substeps=1),
    "dt20_sub2": replace(BASELINE, dt=0.02, substeps=2),
    "dt20_sub1": replace(BASELINE, dt=0.02, substeps=1),
}
"""One dropped cube, named by dt in milliseconds and substeps; the baseline has 10 and 2."""

PUSHED = ContactCase(
    start=(-0.6, -0.15, TOP + 0.04),
    duration=2.0,
    friction=0.10,
    surface_friction=0.50,
    speed=2.0,
    settle=0.30,
)
BESIDE = replace(PUSHED, start=(-0.6, 0.15, TOP + 0.04), friction=0.80)
SLIDES = {
    "low_on_050": PUSHED,
    "high_on_050": BESIDE,
    "low_on_030": replace(PUSHED, surface_friction=0.30),
    "high_on_030": replace(BESIDE, surface_friction=0.30),
}
"""Two cubes of low and high own friction, side by side on two surfaces."""

DROPPED_BALL = ContactCase(
    start=(0.0, 0.0, TOP + 0.04 + 0.10), duration=2.0, shape="ball", spring=(1.0, 0.01)
)
BOUNCES = {f"bounce_sub{n}": replace(DROPPED_BALL, substeps=n) for n in (1, 2, 4, 10, 20, 100)}
"""One ball on a nearly undamped contact, named by its number of substeps."""

CASES = LANDINGS | SLIDES | BOUNCES
"""The runs of the lab."""

STEPS_STUDIED = {
    "h_20000us": (0.02, 1),
    "h_10000us": (0.01, 1),
    "h_5000us": (0.005, 1),
    "h_2500us": (0.0025, 1),
    "h_1250us": (0.00125, 1),
    "h_625us": (0.00125, 2),
    "h_125us": (0.00125, 10),
}
"""Outer step [s] and substeps, named by the solver step in microseconds."""

HEIGHTS_STUDIED = tuple(round(1.0 + 0.0066 * k, 4) for k in range(-4, 5))
"""Initial heights [m]: with them the cubes meet the surface at many phases of a step."""

STEP_CASES = {
    name: {
        f"{name}_{round(1e4 * z)}": replace(
            BASELINE, start=(round(0.2 * k - 0.8, 1), 0.0, z), dt=dt, substeps=n, duration=0.4
        )
        for k, z in enumerate(HEIGHTS_STUDIED)
    }
    for name, (dt, n) in STEPS_STUDIED.items()
}
"""By solver step, the landing from each height side by side, named by the height in 0.1 mm."""

LANDED_AGAIN = {name: case for group in STEP_CASES.values() for name, case in group.items()}
"""All landings of `STEP_CASES`."""

AS_BASELINE = "h_5000us_10000"
"""The landing with the baseline's height and solver step, with each solver step recorded."""

ROUND = {f"{name}_elliptic": replace(case, cone="elliptic") for name, case in SLIDES.items()}
CLEAN_SLIDES = ROUND | {
    f"{name}_sub10": replace(ROUND[name], substeps=10)
    for name in ("low_on_050_elliptic", "high_on_050_elliptic")
}
"""The slides with the engine's other friction model, two of them also with finer steps."""

CONVEX_SLIDES = {
    f"{name}_convex": replace(SLIDES[name], cone="elliptic", resolution="convex", impratio=1.0)
    for name in ("low_on_050", "high_on_050")
}
"""The round cone alone; all other settings are the defaults of the pyramid."""

CONE_CASES = CLEAN_SLIDES | CONVEX_SLIDES

REPEATED = {name: CASES[name] for name in ("baseline", "low_on_050", "high_on_050")}
"""Cases of the lab that the lecture also runs."""

OTHER_ENGINE = {
    f"mujoco_{name}": case
    for name, case in (LANDINGS | SLIDES | CONVEX_SLIDES).items()
    if name != "dt20_sub2" and not name.endswith("_030")
}
"""Cases that also run in MuJoCo with equal settings."""

ENGINE_PAIRS = {
    "baseline": "mujoco_baseline",
    "h_10000us_10000": "mujoco_dt10_sub1",
    "h_20000us_10000": "mujoco_dt20_sub1",
    "low_on_050": "mujoco_low_on_050",
    "high_on_050": "mujoco_high_on_050",
    "low_on_050_convex": "mujoco_low_on_050_convex",
    "high_on_050_convex": "mujoco_high_on_050_convex",
}
"""Runs of the lecture in Genesis and in MuJoCo with equal settings."""

OWN_DEFAULTS = "mujoco_own_baseline"
"""The baseline in MuJoCo with MuJoCo's default contact."""

BY_GENESIS = REPEATED | LANDED_AGAIN | CONE_CASES
"""The runs of the lecture in Genesis."""

STUDY_CASES = BY_GENESIS | OTHER_ENGINE | {OWN_DEFAULTS: BASELINE}
"""All runs of the lecture, in both engines."""

FINER = (("dt10_sub1", "baseline"), ("dt20_sub1", "dt20_sub2"))
"""Pairs that differ in substeps alone, the coarser one first."""

EQUAL_STEP = ("dt10_sub1", "dt20_sub2")
"""A pair with equal solver steps and different outer steps."""

EXPECTED_MODEL = {"entities": 2, "links": 1, "geoms": 1, "joints": 1, "dofs": 6, "qpos": 7}
"""`entities` counts those of the scene with the surface, the others belong to the cube."""

SAME_STATE = 1e-6
"""Tolerance of states at shared times where the solver steps are equal [m]."""

SAME_SLIDE = 1e-4
"""Tolerance of a stopping distance where the friction of the pair did not change [m]."""

COULOMB_SHARE = 0.20
"""Relative tolerance of a stopping distance against Coulomb's: these cubes hop."""

LEVEL_SHARE = 1e-4
"""Tolerance of the conserved energy in a flight, as a share of the energy at the start: float32
rounds in each of up to some thousand solver steps. The bounded error of the total energy is at
least ten times as large."""

FINE_SHARE = 0.3
"""Tolerance of the share kept at the first bounce with the finest step, against a spring [%]."""

COARSE_SHARE = 1.5
"""With some coarser step, that share differs from a spring's by more [%]."""

DEPTH_TOLERANCE = 1e-4
"""Tolerance of a reported depth against that of the positions [m]: corners differ a little."""

SETTLED_START = 2e-3
"""Tolerance of a settled cube's position against its start [m]: it sinks in."""

START_SPEED = 1e-6
"""Tolerance of the first speed against that of the case [m/s]."""

TIME_CONSTANT = 1e-8
"""Tolerance of the engine's time constant of a contact [s]."""

SCATTER_LEFT = 1e-3
"""Largest scatter of the depths at the finest step [m]: cubes from higher up are faster."""

HOP = 0.01
"""Clearance from which a slide counts as a hop [m]."""

SAME_HOP = 1e-4
"""Tolerance of a hop between two engines with equal settings [m]."""

STEPPED_TOLERANCE = 2e-4
"""Tolerance of a slide on four corners against the stepped formula [m]."""

NEARLY = 0.05
"""Relative tolerance of a stopping distance that counts as nearly Coulomb's."""

BLOW = 5.0
"""Loss of speed, in multiples of μ g dt, above which it is more than friction under the weight."""

RATIO_TOLERANCE = 0.02
"""Relative tolerance of the ratio of two impulses against the coefficient of friction."""

RULE_TOLERANCE = 0.02
"""Tolerance of the coefficient that a clean slide shows against that of a rule."""

ENGINES_APART = 5e-5
"""Tolerance of landings between two engines with equal settings [m]."""

VIEW = CAMERA | {"pos": (1.3, -1.5, 1.25), "lookat": (0.0, 0.0, 0.82), "fov": 34}
"""The lesson's camera, with the surface and the whole path of the cube in the picture."""

RESOLUTION = {
    "m": 1e-5, "m/s": 1e-3, "rad/s": 0.05, "s": 0.005, "kg": 1e-6, "1": 0.5, "J": 1e-6, "%": 0.1,
}  # fmt: skip
"""By unit, the difference below which two values count as equal."""

TOLERANCES = {
    "m": (2e-5, 0.0), "m/s": (1e-3, 0.0), "s": (0.0, 0.0), "kg": (1e-6, 0.0), "J": (5e-6, 0.0),
    "%": (0.2, 0.0), "stop_distance": (0.01, 0.0), "final_distance": (0.01, 0.0),
    "stop_time": (0.08, 0.0), "airborne": (0.05, 0.0), "hop": (0.005, 0.0), "rad/s": (12.0, 0.0),
}  # fmt: skip
"""By unit or metric, (atol, rtol) of one metric between engine versions or backends.

After a hop, the contact points at the landing decide the further motion, and no engine is right.
The metrics of that motion have wide tolerances; those of times and spin compare little more than
the order of magnitude. Genesis and MuJoCo with equal settings differ by as much."""

RELATIONS = (
    (("low_on_050", "high_on_050"), "stop_distance", "lower", 0.05),
    (("low_on_050", "low_on_030"), "stop_distance", "higher", 0.05),
)
"""Claimed orderings: ((first, second), metric, order of the second to the first, margin)."""


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    return {
        "cases": {name: asdict(case) for name, case in CASES.items()},
        "surface": {"size_m": SURFACE_SIZE, "top_m": TOP},
        "counted": list(EXPECTED_MODEL),
        "view": {name: value for name, value in VIEW.items() if name != "GUI"},
    }


def study_parameters() -> dict[str, Any]:
    """Return the configured inputs of the lecture, which has other runs."""
    return parameters() | {
        "cases": {name: asdict(case) for name, case in STUDY_CASES.items()},
        "in_mujoco": sorted(OTHER_ENGINE),
        "with_its_own_contact": OWN_DEFAULTS,
        "engine_pairs": ENGINE_PAIRS,
        "steps_studied": {name: list(cases) for name, cases in STEP_CASES.items()},
        "as_baseline": AS_BASELINE,
        "clean_slides": list(CLEAN_SLIDES),
        "convex_slides": list(CONVEX_SLIDES),
    }
