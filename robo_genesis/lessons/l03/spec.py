"""Specification of lesson L03: bodies that land, slide and bounce, and what is claimed of them.

It is data and computes nothing: what of it decides a measured value or a check is in
`parameters()` and `study_parameters()`, and only a change there makes evidence stale.

Source of the parameters of landing and sliding: the public course robo-genesis-101, lesson L03
(https://github.com/datawhalechina/robo-genesis-101), so that figures can be compared.
"""

from dataclasses import asdict, replace
from typing import Any

from robo_genesis.core.scene import CAMERA
from robo_genesis.sim.contacts import SURFACE_SIZE, TOP, ContactCase

LESSON = "l03"
MINIMUM_HARDWARE = "cpu"
STUDY_PAGE = "lecture"
"""The page of the lesson that runs the studies."""

LINK = "body"
"""What the one link of each run is called in the record; the engine's name goes with the shape."""

BASELINE = ContactCase(start=(0.0, 0.0, 1.0), duration=1.5)
LANDINGS = {
    "baseline": BASELINE,
    "dt10_sub1": replace(BASELINE, substeps=1),
    "dt20_sub2": replace(BASELINE, dt=0.02, substeps=2),
    "dt20_sub1": replace(BASELINE, dt=0.02, substeps=1),
}
"""One cube, dropped; dt in milliseconds and substeps are the names, 10 and 2 are the baseline's."""

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
"""Two cubes of low and high friction of their own, side by side on two surfaces."""

DROPPED_BALL = ContactCase(
    start=(0.0, 0.0, TOP + 0.04 + 0.10), duration=2.0, shape="ball", spring=(1.0, 0.01)
)
BOUNCES = {f"bounce_sub{n}": replace(DROPPED_BALL, substeps=n) for n in (1, 2, 4, 10, 20, 100)}
"""One ball on a nearly undamped contact; the number of substeps is the name."""

CASES = LANDINGS | SLIDES | BOUNCES
"""The lab's runs."""

STEPS_STUDIED = {
    "h_20000us": (0.02, 1),
    "h_10000us": (0.01, 1),
    "h_5000us": (0.005, 1),
    "h_2500us": (0.0025, 1),
    "h_1250us": (0.00125, 1),
    "h_625us": (0.00125, 2),
    "h_125us": (0.00125, 10),
}
"""Outer step [s] and substeps; the solver's step in microseconds is the name."""

HEIGHTS_STUDIED = tuple(round(1.0 + 0.0066 * k, 4) for k in range(-4, 5))
"""Heights to fall from [m]: a step's distance at landing is met by them at many phases."""

STEP_CASES = {
    name: {
        f"{name}_{round(1e4 * z)}": replace(
            BASELINE, start=(round(0.2 * k - 0.8, 1), 0.0, z), dt=dt, substeps=n, duration=0.4
        )
        for k, z in enumerate(HEIGHTS_STUDIED)
    }
    for name, (dt, n) in STEPS_STUDIED.items()
}
"""By solver step, the landing from each height, side by side; the height in 0.1 mm is the name."""

LANDED_AGAIN = {name: case for group in STEP_CASES.values() for name, case in group.items()}
"""All of these runs."""

AS_BASELINE = "h_5000us_10000"
"""The one of them that falls and is stepped as the baseline is, with each solver step recorded."""

CLEAN_SLIDES = {
    f"{name}_elliptic": replace(case, cone="elliptic") for name, case in SLIDES.items()
} | {
    f"{name}_elliptic_sub10": replace(SLIDES[name], cone="elliptic", substeps=10)
    for name in ("low_on_050", "high_on_050")
}
"""The slides with the engine's other model of friction, two of them with finer steps."""

CONVEX_SLIDES = {
    f"{name}_convex": replace(SLIDES[name], cone="elliptic", resolution="convex", impratio=1.0)
    for name in ("low_on_050", "high_on_050")
}
"""The round cone alone, with all else as it is by default with the pyramid."""

CONE_CASES = CLEAN_SLIDES | CONVEX_SLIDES

REPEATED = {name: CASES[name] for name in ("baseline", "low_on_050", "high_on_050")}
"""Cases of the lab that the lecture runs, too."""

OTHER_ENGINE = {
    f"mujoco_{name}": case
    for name, case in (LANDINGS | SLIDES | CONVEX_SLIDES).items()
    if name != "dt20_sub2" and not name.endswith("_030")
}
"""Cases that are run in MuJoCo with equal settings."""

ENGINE_PAIRS = {
    "baseline": "mujoco_baseline",
    "h_10000us_10000": "mujoco_dt10_sub1",
    "h_20000us_10000": "mujoco_dt20_sub1",
    "low_on_050": "mujoco_low_on_050",
    "high_on_050": "mujoco_high_on_050",
    "low_on_050_convex": "mujoco_low_on_050_convex",
    "high_on_050_convex": "mujoco_high_on_050_convex",
}
"""Runs of the lecture that both engines make with equal settings."""

OWN_DEFAULTS = "mujoco_own_baseline"
"""The baseline in MuJoCo with MuJoCo's own contact."""

BY_GENESIS = REPEATED | LANDED_AGAIN | CONE_CASES
"""Those of the lecture's runs that the course's engine makes."""

STUDY_CASES = BY_GENESIS | OTHER_ENGINE | {OWN_DEFAULTS: BASELINE}
"""All runs of the lecture."""

FINER = (("dt10_sub1", "baseline"), ("dt20_sub1", "dt20_sub2"))
"""Pairs that differ in substeps alone, the coarser one first."""

EQUAL_STEP = ("dt10_sub1", "dt20_sub2")
"""A pair of equal solver step and other outer steps."""

EXPECTED_MODEL = {"entities": 2, "links": 1, "geoms": 1, "joints": 1, "dofs": 6, "qpos": 7}
"""Of the baseline's scene (entities, the surface among them) and of its cube."""

SAME_STATE = 1e-6
"""What states at shared times may differ by where the solver's steps are the same [m]."""

SAME_SLIDE = 1e-4
"""What a stopping distance may change by where the pair's friction did not [m]."""

COULOMB_SHARE = 0.20
"""What a stopping distance may differ from Coulomb's by, as a share of it: these cubes hop."""

LEVEL_SHARE = 1e-4
"""What the kept energy may change by in a flight, as a share of that at the start: float32 rounds
in each of up to some thousand solver steps. The lent part is ten times as large at least."""

FINE_SHARE = 0.3
"""What the finest step may keep at the first bounce beside what a linear spring does [%]."""

ENGINES_APART = 5e-5
"""What landings and the first hop may differ by between two engines of equal settings [m]."""

VIEW = CAMERA | {"pos": (1.3, -1.5, 1.25), "lookat": (0.0, 0.0, 0.82), "fov": 34}
"""The lesson's camera, with the surface and the cube's whole way in the picture."""

RESOLUTION = {
    "m": 1e-5, "m/s": 1e-3, "rad/s": 0.05, "s": 0.005, "kg": 1e-6, "1": 0.5, "J": 1e-6, "%": 0.1,
}  # fmt: skip
"""Differences below these are called equal, by unit."""

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
}
"""By unit or metric, (atol, rtol) that one may differ by between engine versions or backends.

Where a cube has hopped, the contact points that are found at its landing decide how it goes on, and
no engine is right: what comes after has wide ones, those of times and spin little more than the
order of magnitude. Genesis and MuJoCo with equal settings differ by as much."""

RELATIONS = (
    (("low_on_050", "high_on_050"), "stop_distance", "lower", 0.05),
    (("low_on_050", "low_on_030"), "stop_distance", "higher", 0.05),
)
"""Orderings that the lesson claims: ((first, second), metric, second against first, margin)."""


def parameters() -> dict[str, Any]:
    """Return every configured input of the lab as JSON values, for the evidence key."""
    return {
        "cases": {name: asdict(case) for name, case in CASES.items()},
        "surface": {"size_m": SURFACE_SIZE, "top_m": TOP},
        "expected_model": dict(EXPECTED_MODEL),
        "view": {name: value for name, value in VIEW.items() if name != "GUI"},
        "finer": FINER,
        "equal_step": EQUAL_STEP,
        "same_state_m": SAME_STATE,
        "same_slide_m": SAME_SLIDE,
        "coulomb_share": COULOMB_SHARE,
        "level_share": LEVEL_SHARE,
        "fine_share_percent": FINE_SHARE,
    }


def study_parameters() -> dict[str, Any]:
    """Return those of the lecture, whose runs are others."""
    own = {"cases": {name: asdict(case) for name, case in STUDY_CASES.items()}}
    elsewhere = {"in_mujoco": sorted(OTHER_ENGINE), "with_its_own_contact": OWN_DEFAULTS}
    return parameters() | own | elsewhere | {"engines_apart_m": ENGINES_APART}
