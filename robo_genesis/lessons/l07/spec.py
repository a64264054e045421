"""Specification of lesson L07: joint4 turns to a target, with two gains. Data only."""

from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core import check_spec
from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import DT
from robo_genesis.lessons.l07 import rest
from robo_genesis.sim.arm.franka import JOINT_NAMES, KP_BASELINE, Q_START
from robo_genesis.sim.arm.joint_control import ControlCase

MEASURES = False

MINIMUM_HARDWARE = "cpu"
JOINT, ENTRY = "joint4", 3
TURNED = Q_START + 0.2 * np.eye(len(JOINT_NAMES))[ENTRY]  # [rad]
BASELINE = ControlCase(q_target=TURNED, steps=60)
CASES = {"baseline": BASELINE, "kp_halved": replace(BASELINE, kp=KP_BASELINE / 2)}

ARRIVED = 0.05  # the largest distance from the target that counts as arrived [rad]
RESOLUTION = rest.RESOLUTION | {"rad": 1e-5, "rad/s": 1e-3, "s": DT / 2, "1": 0.5}
LABELS = rest.LABELS
TOLERANCES, RELATIONS = check_spec.TOLERANCES | rest.TOLERANCES, ()


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    return inputs(CASES)
