"""Boxes at rest on a level and on a tilted table: cases, and the criterion of rest."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.experiment import inputs
from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.bodies.contacts import TOP, ContactCase

# A body is at rest if no coordinate ranges over more than this [m] in a window [s].
WINDOW, BOUND = 0.2, 2e-4

SPEED = ("link_vel_m_s", "link_ang_rad_s", "t_s")
SLOW = 1e-3  # The criterion of a speed that the page examines [m/s]

# The box of all runs. Its friction counts, because that of the table is smaller.
BOX = ContactCase(
    start=(0.0, 0.0, TOP + 0.025),
    size=0.05,
    duration=0.5,
    friction=0.5,
    surface_friction=0.1,
    substeps=4,
)

# By 5 mm, on a level table
FALLING = replace(BOX, start=(0.0, 0.0, TOP + 0.03), substeps=2)

# Six boxes side by side across the slope, and what distinguishes each from `BOX`.
ROW = {
    "slick": {"friction": 0.3},
    "box": {},
    "firm": {"friction": 1.0},
    "rough": {"friction": 2.0},
    "small": {"size": 0.02},
    "heavy": {"density": 8000.0},
}

STEEP = {"mu_150": {"friction": 1.5}} | {name: ROW[name] for name in [*ROW][1:]}


def rows(
    of: Mapping[str, Mapping[str, float]] = ROW, /, **scenes: Any
) -> dict[str, Any]:
    """Return scenes with boxes side by side by name, from their tilt [°] and other settings."""
    found: dict[str, dict[str, ContactCase]] = {scene: {} for scene in scenes}
    for scene, (tilt, settings) in scenes.items():
        for k, (name, own) in enumerate(of.items()):
            case = replace(BOX, **{"tilt": np.radians(tilt), **settings, **own})
            place = (0.0, round(0.1 * k - 0.3, 1), case.rest_height)
            found[scene][f"{scene}_{name}"] = replace(case, start=place)
    return found


PYRAMIDS = rows(
    **{f"tilt_{tilt}": (tilt, {}) for tilt in (0, 5, 10)},
    h_5ms=(10, {"substeps": 2}),
    h_1ms=(10, {"substeps": 10}),
    T_5ms=(10, {"time_constant": 0.005}),
    T_20ms=(10, {"time_constant": 0.02}),
) | rows(STEEP, tilt_15=(15, {}), tilt_20=(20, {}))
# With the engine's impratio for it
ROUND = {"cone": "elliptic", "impratio": 100.0, "settle": 0.3}
LEVEL = rows(elliptic_0=(0, ROUND))
ELLIPTIC = rows(elliptic_10=(10, ROUND))
COMPARED = PYRAMIDS | ELLIPTIC  # Some of their boxes run in MuJoCo as well
ALONE = {
    "alone": {"alone_box": replace(BOX, tilt=np.radians(10))},
    "fall": {"fall_box": FALLING},
}

# The runs in Genesis, by scene.
SCENES = ALONE | COMPARED | LEVEL

CASES = {name: case for scene in SCENES.values() for name, case in scene.items()}

# Runs in MuJoCo with equal settings, in float64.
TWINS = {
    f"mujoco_{name}": case
    for scene in COMPARED.values()
    for name, case in scene.items()
    if name.endswith(("_box", "_firm", "_rough"))
}

# Words of a reader for runs.
LABELS = {
    "tilt_10_box": "μ = 0.5",
    "tilt_10_slick": "μ = 0.3",
    "tilt_10_firm": "μ = 1",
    "tilt_10_rough": "μ = 2",
    "tilt_10_heavy": "16 times the density",
    "tilt_10_small": "edge 20 mm",
    "h_5ms_box": "h = 5 ms",
    "h_1ms_box": "h = 1 ms",
    "T_5ms_box": "T = 5 ms",
    "T_20ms_box": "T = 20 ms",
    "elliptic_10_box": "elliptic cone, impratio 100",
}

# The contact points of sliding boxes decide. All others differ by rounding.
# By metric or case, (atol, rtol) of a value between engines, backends or processors.
TOLERANCES = {
    "creep": (2e-5, 0.2),
    "sunk": (1e-3, 0.05),
    "moved": (1e-5, 0.2),
    **dict.fromkeys([*CASES, *TWINS], (5e-3, 0.0)),
}

# By unit, the difference below which two values are equal. float32 changes a creep by
# up to 3e-6 m/s at a solver step of 1 ms.
RESOLUTION = {"m": 1e-5, "m/s": 5e-6, "%": 1.0}


def in_scope(case: ContactCase) -> bool:
    """Return whether all edges of a box with the pyramid press, as the formula of creep assumes."""
    return bool(np.tan(case.tilt) <= case.friction / (2 + case.friction))


def moved(trace: ContactTrace) -> float:
    """Return the largest range of a coordinate of the centre in the last window [m]."""
    n = round(WINDOW / trace.dt)
    return float(np.ptp(trace.link_pos[-n - 1 :, 0].astype(float), axis=0).max())


@dataclass(frozen=True, slots=True)
class RestMetrics(CaseMetrics):
    """How a box rests on the table."""

    creep: float = metric("m/s", "creep along the table", "link_pos_m")
    sunk: float = metric("m", "support error", "link_pos_m")
    moved: float = metric("m", "range of a coordinate in the last window", "link_pos_m")
    slow_at: float | None = metric("s", "first slow sample after the start", *SPEED)
    fast_until: float | None = metric("s", "last fast sample", *SPEED)


def rest_metrics(trace: ContactTrace, case: ContactCase) -> RestMetrics:
    """Measure one run."""
    n, place = round(WINDOW / case.dt), trace.link_pos[:, 0].astype(np.float64)
    path = np.linalg.norm((place[-1] - place[-1 - n])[:2])
    v, w = (np.linalg.norm(of[:, 0], axis=1) for of in (trace.link_vel, trace.link_ang))
    speeds = v + w * case.size * np.sqrt(3) / 2  # the largest that a corner can have
    slow, fast = np.flatnonzero(speeds[1:] < SLOW) + 1, np.flatnonzero(speeds >= SLOW)
    return RestMetrics(
        float(path) / WINDOW,
        case.rest_height - place[-1, 2],
        moved(trace),
        trace.t[slow[0]] if len(slow) else None,
        trace.t[fast[-1]] if len(fast) else None,
    )


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    return inputs(CASES, twins=list(TWINS), window=[WINDOW, BOUND], slow=SLOW)
