"""Specification of lesson L04: cases, predictions, margins and tolerances.

Pages, checks, verification and tests read the experiment here. The module is data and
computes nothing. `parameters()` has the values that decide what runs and how a metric
is computed; only a change there makes evidence stale. All other values only judge.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core import check_spec
from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import DT
from robo_genesis.sim.arm import franka
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joint_control import ControlCase

from .metrics import RISE_FRACTION, SATURATION_THRESHOLD, SETTLING_BAND

MEASURES = False

MINIMUM_HARDWARE = "cpu"

STEPPED_JOINT = "joint4"
ENTRY = JOINT_NAMES.index(STEPPED_JOINT)  # Column of the stepped joint in all arrays

STEP = 0.25  # Height of the commanded step [rad]
WINDOW = 1.2  # Length of every run [s]
STEPS = round(WINDOW / DT)

EXPECTED_MODEL, EXPECTED_TYPES = franka.MODEL_COUNTS, franka.JOINT_TYPES

# By unit: values that differ by no more than this are called equal, the noise floor.
RESOLUTION = {"rad": 1e-4, "rad/s": 1e-3, "s": DT / 2, "N·m": 1e-2, "1": 0.5}


def changed(case: ControlCase, entry: int = ENTRY, **entries: float) -> ControlCase:
    """Return a case that differs in one entry of some fields, by default the stepped joint's."""
    fields: dict[str, Any] = {name: np.array(getattr(case, name)) for name in entries}
    for name, value in entries.items():
        fields[name][entry] = value
        fields[name].setflags(write=False)
    return replace(case, **fields)


START_OF_STEP = float(franka.Q_START[ENTRY])

AT_START = ControlCase(q_target=franka.Q_START, steps=STEPS)
BASELINE = changed(AT_START, q_target=START_OF_STEP + STEP)
G1 = changed(BASELINE, kp=3500.0, kv=100.0)
G2 = changed(G1, kp=7000.0)
G3 = changed(G2, kv=300.0)

CASES = {"baseline": BASELINE, "G1": G1, "G2": G2, "G3": G3}

# The mark of each case in the palette.
CASE_MARKS = {"baseline": "baseline", "G1": "first", "G2": "second", "G3": "third"}

# The only entry that may differ between two compared cases.
ONE_FACTOR = {
    ("G1", "G2"): [f"kp[{STEPPED_JOINT}]"],
    ("G2", "G3"): [f"kv[{STEPPED_JOINT}]"],
}

# An order counts as shown when the difference exceeds this margin. The margins are
# above `RESOLUTION`, because a time or a count may fall one sample to either side.
MARGINS = {
    "rise_time": 1.5 * DT,
    "settling_time": 1.5 * DT,
    "peak_speed": 0.05,
    "overshoot": 1e-3,
    "saturation_samples": 1.5,
}

# The lesson's predictions: how the second case of a pair compares with the first. They
# are not fitted to a run, and a refreshed run must still show them.
RELATIONS = tuple(
    (pair, metric, order, MARGINS[metric])
    for pair, metric, order in (
        (("G1", "G2"), "rise_time", "no later"),
        (("G1", "G2"), "peak_speed", "higher"),
        (("G1", "G2"), "overshoot", "higher"),
        (("G1", "G2"), "saturation_samples", "higher"),
        (("G2", "G3"), "peak_speed", "lower"),
        (("G2", "G3"), "overshoot", "lower"),
        (("G2", "G3"), "rise_time", "later"),
    )
)

# By unit, or by metric or array: (atol, rtol) of a value between engine versions or
# backends. A time on the grid of samples must not move at all; counts are exact.
TOLERANCES = check_spec.TOLERANCES | {
    "rad": (1e-4, 1e-3),
    "s": (DT / 2, 0.0),
    "kg·m²": (1e-4, 1e-3),
    "N·m·s/rad": (1e-6, 0.0),
    "initial_error": (1e-6, 0.0),
    "m": (1e-4, 1e-3),
}


def parameters() -> dict[str, Any]:
    """Return every configured input of the lesson as JSON values, for the evidence key.

    Expected values, predictions, margins, tolerances and resolutions are not inputs:
    they judge the measurement and do not change it.
    """
    return inputs(
        CASES,
        stepped_joint=STEPPED_JOINT,
        counted=list(EXPECTED_MODEL),
        rise_fraction=RISE_FRACTION,
        settling_band_rad=SETTLING_BAND,
        saturation_threshold=SATURATION_THRESHOLD,
    )
