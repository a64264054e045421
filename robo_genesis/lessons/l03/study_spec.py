"""Specification of L03's lecture, deeper pages and mistakes: cases beyond the lab, tolerances."""

from dataclasses import replace
from typing import Any

from robo_genesis.core.experiment import case_inputs
from robo_genesis.sim.bodies.contacts import ContactCase

from .spec import BASELINE, BESIDE, BOUNCES, LANDINGS, PUSHED, SLIDES

MEASURES = False

# The landings of the lecture's first replay; the cubes have settled at its end.
DROPPED = {
    name: replace(LANDINGS[name], duration=0.5) for name in ("baseline", "dt10_sub1")
}

# The camera frames of both at their deepest sample, with words for the solver step.
DEEPEST = {"deepest_10ms": "h = 10 ms", "deepest_5ms": "h = 5 ms"}

# The camera's pose for them: at the height of the surface, on the side of the light.
CLOSE = {"pos": (0.0, 0.75, 0.742), "lookat": (0.0, 0.0, 0.745), "up": (0.0, 0.0, 1.0)}

# The slides of the lecture's second replay, with the engine's default friction model.
HOPPED = {name: SLIDES[name] for name in ("low_on_050", "high_on_050")}


def by_step(kind: str, *steps: tuple[float, int]) -> dict[str, dict[str, Any]]:
    """Return settings by outer step [s] and substeps, named by the solver step: `h_2500us`."""
    return {
        f"{kind}_{1e6 * dt / n:.0f}us": {"dt": dt, "substeps": n} for dt, n in steps
    }


# Landings by solver step and by time constant

# Initial heights [m]: with them the cubes meet the surface at many phases of a step.
HEIGHTS_STUDIED = tuple(round(1.0 + 0.0066 * k, 4) for k in range(-4, 5))


def side_by_side(
    name: str,
    heights: tuple[float, ...] = HEIGHTS_STUDIED,
    duration: float = 0.4,
    **settings: Any,
) -> dict[str, ContactCase]:
    """Return a landing from each height, in one row, named by the height in 0.1 mm."""
    return {
        f"{name}_{round(1e4 * z)}": replace(
            BASELINE,
            start=(round(0.2 * k - 0.8, 1), 0.0, z),
            duration=duration,
            **settings,
        )
        for k, z in enumerate(heights)
    }


STEPS = (
    (0.02, 1),
    (0.01, 1),
    (0.005, 1),
    (0.004, 1),
    (0.0025, 1),
    (0.001, 1),
    (0.001, 2),
    (0.001, 8),
)

# By solver step, the landing from each height with the default time constant.
STEP_CASES = {
    name: side_by_side(name, **step) for name, step in by_step("h", *STEPS).items()
}

STIFF = "T_2ms"

# The landings with a time constant of 2 ms, with a twentieth of it as solver step.
STIFF_CASES = {STIFF: side_by_side(STIFF, time_constant=0.002, dt=0.0005, substeps=5)}

# The landings by time constant, each with a fortieth of it as solver step. All cubes
# are at the top of their rebound before the end.
RELEASE_CASES = {
    name: side_by_side(
        name, HEIGHTS_STUDIED[::4], 0.275, time_constant=seconds, dt=dt, substeps=n
    )
    for name, seconds, dt, n in (
        ("release_10ms", 0.010, 0.001, 4),
        ("release_5ms", 0.005, 0.001, 8),
        ("release_2ms", 0.002, 0.0005, 10),
    )
}

# Slides with the elliptic cone

# The lab's slides with the engine's other friction model.
ELLIPTIC = {
    f"{name}_elliptic": replace(case, cone="elliptic") for name, case in SLIDES.items()
}

FINER_SLIDES = {
    f"{name}_sub10": replace(ELLIPTIC[name], substeps=10)
    for name in ("low_on_050_elliptic", "high_on_050_elliptic")
}

# The elliptic cone alone; all other settings are the defaults of the pyramid.
CONVEX_SLIDES = {
    f"{name}_convex": replace(
        SLIDES[name], cone="elliptic", resolution="convex", impratio=1.0
    )
    for name in HOPPED
}

# Pushes with the default cone


def pushes(kind: str, duration: float, *steps: tuple[float, int]) -> dict[str, Any]:
    """Return by solver step the pushes of both cubes to 2 m/s, recorded for `duration` [s]."""
    cubes = {"low": PUSHED, "high": BESIDE}
    return {
        name: {
            f"{name}_{c}": replace(of, duration=duration, **step)
            for c, of in cubes.items()
        }
        for name, step in by_step(kind, *steps).items()
    }


HOP_STEP_CASES = pushes(
    "hop",
    0.4,
    (0.01, 1),
    (0.005, 1),
    (0.0025, 1),
    (0.002, 1),
    (0.001, 1),
    (0.001, 2),
    (0.001, 10),
)

# Those that are recorded until they stop; `HOPPED` continues them at 5 ms.
STOP_CASES = pushes(
    "stop",
    1.2,
    (0.0025, 1),
    (0.001, 1),
    (0.001, 2),
    (0.001, 4),
    (0.001, 8),
    (0.02, 200),
    (0.001, 12),
)

# The cube with the low coefficient, pushed at each speed [m/s] with a solver step of 5
# ms.
HOP_SPEED_CASES = {
    f"hop_{round(1000 * speed)}mm_s": replace(
        PUSHED,
        start=(-0.6, round(0.16 * k - 0.32, 2), 0.765),
        speed=speed,
        dt=0.005,
        substeps=1,
        duration=0.4,
    )
    for k, speed in enumerate((0.1, 0.2, 0.5, 1.0, 2.0))
}

# The second engine

COMPARED = ("baseline", "dt10_sub1", "dt20_sub1")  # Landings that also run in MuJoCo

BY_BOTH = {name: LANDINGS[name] for name in COMPARED} | HOPPED | CONVEX_SLIDES

# Runs in Genesis and in MuJoCo with equal settings.
ENGINE_PAIRS = {name: f"mujoco_{name}" for name in BY_BOTH}

# The baseline in MuJoCo with MuJoCo's default contact
OWN_DEFAULTS = "mujoco_own_baseline"

IN_MUJOCO = {ENGINE_PAIRS[name]: case for name, case in BY_BOTH.items()} | {
    OWN_DEFAULTS: BASELINE
}


# The runs in Genesis of each page, by scene or by the studies that belong together.
SCENES = {
    "lecture": {
        "dropped": DROPPED,
        **STEP_CASES,
        **STIFF_CASES,
        "elliptic": ELLIPTIC,
        "hopped": HOPPED,
        **HOP_STEP_CASES,
        "hop_speeds": HOP_SPEED_CASES,
    },
    "contact": {
        "by_both": BY_BOTH,
        "elliptic": ELLIPTIC,
        "finer": FINER_SLIDES,
        **STOP_CASES,
    },
    "energy": {"bounces": BOUNCES, **RELEASE_CASES},
    "mistakes": {"landings": LANDINGS, "hopped": HOPPED},
}

# The same without scenes.
CASES_OF = {
    page: {name: case for cases in scenes.values() for name, case in cases.items()}
    for page, scenes in SCENES.items()
}

# Limits, and tolerances of what comments name, that only judge; a share is relative

# Of a depth against v T / e, by scene with fine steps: at depths of a millimetre, with
# a time constant of 2 ms, the contact is softer.
DEPTH_SHARES = {"h_125us": 0.1, STIFF: 0.2}

FIRST_DEPTH = 2e-5  # Of a depth against that of the first sample in the table [m]
SCATTER_COARSE = 0.5  # Least scatter of depth / (v T / e) over the heights at h = T / 2
SCATTER_FINE = 0.05  # Largest one at the finest step
TIME_CONSTANT = 1e-8  # Of the engine's time constant of a contact [s]
RELEASE_SHARE = 0.1  # Of the speed of release against e⁻² of the impact speed
REBOUND_SHARE = 0.25  # Of a rebound against that of a linear contact

HOP = 0.01  # Clearance from which a slide counts as a hop [m]
HOP_SHARE = 0.25  # Of a hop against the formula of one step, where it applies

# The steps at which the formula of one step is compared: the first step throws the cube
# off.
HOP_APPLIES = ("hop_10000us", "hop_5000us", "hop_2500us", "hop_2000us")
# Largest share of the hop at 5 ms that is left at the smaller steps studied
HOP_LEFT = 0.15
INVISIBLE = 1e-3  # Height of a hop that nobody sees in a film of the scene [m]
SLOW = 0.2  # Speed up to which a hop is invisible at a solver step of 5 ms [m/s]

STEPPED_TOLERANCE = 2e-4  # Of a slide on four corners against the stepped formula [m]
# Of the coefficient that a clean slide shows against that of a rule
RULE_TOLERANCE = 0.02
NEARLY = 0.05  # Share of a stopping distance that counts as nearly Coulomb's
# Share of the ratio of two impulses against the coefficient of friction
RATIO_TOLERANCE = 0.02
# Loss of speed, in multiples of μ g dt, that friction under the weight cannot cause
BLOW = 5.0
# Number of the smallest steps that are compared for convergence, all at most T / 10
FINEST = 6

# Change at a finer step, or spread over the finest steps, from which a stopping
# distance depends on the step, as a share of Coulomb's distance.
UNSETTLED = 0.05

SAME_HOP = 1e-4  # Of a hop between two engines with equal settings [m]
ENGINES_APART = 5e-5  # Of landings between them [m], and of quaternions [1]


def parameters(page: str) -> dict[str, Any]:
    """Return every configured input of a page's own runs as JSON values, for the evidence key."""
    found: dict[str, Any] = {
        name: case_inputs(cases) for name, cases in SCENES[page].items()
    }
    if page == "contact":
        found |= {"engine_pairs": ENGINE_PAIRS, "with_its_own_contact": OWN_DEFAULTS}
    return {"studies": found}
