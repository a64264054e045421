"""Specification of lesson L06: a box falls a short way and comes to rest. Data only."""

from dataclasses import asdict
from typing import Any

from robo_genesis.core.scene import CAMERA, DT
from robo_genesis.sim.rigid_bodies import Drop

MINIMUM_HARDWARE = "cpu"
BASELINE = Drop(size=0.10, density=500.0, height=0.06, steps=50)
CASES = {"baseline": BASELINE}
LINK = "box_baselink"
EXPECTED_MODEL = {"entities": 2, "links": 1, "geoms": 1, "joints": 1, "dofs": 6, "qpos": 7}
VIEW = CAMERA | {"pos": (0.5, -0.5, 0.3), "lookat": (0.0, 0.0, 0.05), "fov": 40}

HEIGHT_TOLERANCE = 2e-3  # between the ground and the underside at the end [m]
AT_REST = 1e-2  # a lower speed counts as rest [m/s]
RESOLUTION = {"m": 1e-5, "m/s": 1e-3, "s": DT / 2, "1": 0.5}
TOLERANCES = {"m": (1e-4, 0.0), "m/s": (1e-3, 0.0), "s": (0.0, 0.0)}
RELATIONS = ()


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    view = {name: value for name, value in VIEW.items() if name != "GUI"}
    cases = {name: asdict(case) for name, case in CASES.items()}
    return {"cases": cases, "counted": list(EXPECTED_MODEL), "view": view}
