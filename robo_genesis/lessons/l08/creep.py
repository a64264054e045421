"""Boxes that two pads hold: cases, metrics, and what a reader may change."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.experiment import inputs
from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.grippers import PAD, SIZE, HeldCase

# Runs that differ from `base` in one setting, by setting and name.
SCANS: Mapping[str, Mapping[str, float]] = {
    "friction": {"mu_03": 0.3, "mu_05": 0.5, "base": 1.0, "mu_15": 1.5, "mu_2": 2.0},
    "force": {"N_2": 2.0, "N_5": 5.0, "base": 10.0, "N_20": 20.0, "N_40": 40.0},
    "mass": {
        "m_005": 0.05,
        "base": 0.1,
        "m_02": 0.2,
        "m_05": 0.5,
        "m_09": 0.9,
        "m_15": 1.5,
    },
}

SCAN = {name: {of: value} for of, row in SCANS.items() for name, value in row.items()}

# Boxes of each other scene. The weight of `m_15` is more than µN, that of the others is
# less.
ROW = {name: SCAN[name] for name in ("base", "mu_03", "mu_2", "m_09", "m_15")}

# Without the box that would sink in by 5 mm.
SHALLOW = {name: own for name, own in ROW.items() if name != "mu_2"}


def side_by_side(
    boxes: Mapping[str, Mapping[str, float]], prefix: str = "", **common: Any
) -> dict[str, HeldCase]:
    """Return grippers in a row along y, with a prefix before their names."""
    return {
        prefix + name: HeldCase(place=round(0.1 * k, 1), **common | {**own})
        for k, (name, own) in enumerate(boxes.items())
    }


# Settings of each other scene; most have the boxes of `ROW`.
SETTINGS: dict[str, dict[str, Any]] = {
    "plain": {},
    "T_5ms": {"time_constant": 0.005},
    "T_20ms": {"time_constant": 0.02},
    "h_1ms": {"substeps": 10},
    "iterations_500": {"iterations": 500},
    "elliptic_1": {"cone": "elliptic", "impratio": 1.0},
    "elliptic_10": {"cone": "elliptic", "impratio": 10.0},
    "elliptic": {"cone": "elliptic"},
    "pyramid_10": {"impratio": 10.0},
    "pyramid_100": {"impratio": 100.0},
    "noslip_5": {"noslip": 5},
}


# Mass whose weight is µN [kg].
LIGHT = HeldCase().friction * HeldCase().force / HeldCase().gravity

# The runs in Genesis, by scene.
SCENES = {
    "long": side_by_side({"long": {}}, dt=0.1, substeps=40, duration=10.0),
    "scan": side_by_side(SCAN),
} | {
    name: side_by_side(SHALLOW if name == "T_20ms" else ROW, f"{name}_", **settings)
    for name, settings in SETTINGS.items()
}

CASES = {n: case for of in SCENES.values() for n, case in of.items()}

# Scenes whose steps are timed: they have the same boxes.
TIMED = [name for name, cases in SCENES.items() if len(cases) == len(ROW)]

# Runs of the box of 1.5 kg by scene, with gravity turned by 0 or 45° in the plane of the
# pads.
TURNED = {
    f"{of}_{turn}": (of, turn) for of in ("plain", "elliptic") for turn in (0, 45)
}

# The same runs in MuJoCo, in float64.
TWINS = {f"mujoco_{name}": case for name, case in CASES.items()}

# What users try, by run: words, the run without it, and its price beside computing
# time.
CHANGES = {
    "base": ("nothing", "base", "–"),
    "mu_2": ("friction 1 → 2", "base", "a deeper contact"),
    "N_40": ("force 10 → 40 N", "base", "a deeper contact, four times the force"),
    "m_05": ("5 times the mass", "base", "–"),
    "h_1ms_base": ("step 2.5 → 1 ms", "base", "–"),
    "iterations_500_base": ("500 solver iterations", "base", "–"),
    "T_5ms_base": ("T 10 → 5 ms", "base", "a step of at most T/2"),
    "T_20ms_base": ("T 10 → 20 ms", "base", "a deeper contact"),
    "noslip_5_base": ("noslip, 5 iterations", "base", "no elliptic cone"),
    "noslip_5_m_15": ("the same, *mg* > µN", "m_15", "no elliptic cone"),
    "elliptic_1_base": ("elliptic, impratio 1", "base", "depth as with µ = 1"),
    "elliptic_base": (
        "elliptic, impratio 100",
        "base",
        "depth as with µ = 1; no noslip",
    ),
    "pyramid_100_base": ("pyramid, impratio 100", "base", "a stiffer normal direction"),
}

# Words of a reader for runs.
LABELS = {
    "long": "10 s",
    "base": "μ = 1",
    "mu_2": "μ = 2",
    "h_1ms_base": "h = 1 ms",
    "T_5ms_base": "T = 5 ms",
    "m_15": "1.5 kg",
    "noslip_5_m_15": "1.5 kg, noslip",
    "noslip_5_base": "noslip",
    "elliptic_base": "elliptic cone, impratio 100",
}

# By metric, (atol, rtol) of a value between engines, backends or processors.
TOLERANCES: dict[str, tuple[float, float]] = {
    "creep": (4e-6, 0.005),
    "depth": (1e-7, 0.005),
    "path": (4e-6, 0.005),
}

RESOLUTION = {"m/s": 5e-6}


@dataclass(frozen=True, slots=True)
class HeldMetrics(CaseMetrics):
    """How a held box slides."""

    creep: float = metric("m/s", "creep down the pads", "link_pos_m")
    depth: float = metric("m", "depth of the contacts", "link_pos_m")
    path: float = metric("m", "path down the pads", "link_pos_m")


def held_metrics(trace: BodyTrace, case: HeldCase) -> HeldMetrics:
    """Measure one run."""
    place = trace.link_pos.astype(np.float64)
    path = place[0, 0, 2] - place[-1, 0, 2]
    gap = (
        place[-1, 2, 0] - place[-1, 1, 0]
    ) / 2  # half of the distance of the pads' centres
    depth = SIZE / 2 + PAD[0] - gap
    return HeldMetrics(float(path) / case.duration, float(depth), float(path))


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    return inputs(CASES, twins=list(TWINS), turned=list(TURNED))
