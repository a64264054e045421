"""Specification of lesson L04's grid of steps: gains and step sizes around the compared cases."""

from dataclasses import dataclass, replace
from itertools import product

from robo_genesis.core.scene import JOINT_NAMES
from robo_genesis.lessons.l04.spec import G1, START_OF_STEP, STEP, STEPPED_JOINT, with_entry
from robo_genesis.lessons.l04.study_spec import COMPARED, commanded
from robo_genesis.sim.joint_control import ControlCase

STEP_SIZES = (0.02, 0.05, 0.1, STEP)
"""Heights of the commanded step [rad]."""

KP = (3500.0, 4375.0, 5250.0, 6125.0, 7000.0)
"""Position gains of the stepped joint [N·m/rad]."""

KV = (100.0, 150.0, 200.0, 250.0, 300.0)
"""Velocity gains of the stepped joint [N·m·s/rad]."""

ENTRY = JOINT_NAMES.index(STEPPED_JOINT)


@dataclass(frozen=True, slots=True)
class GridPoint:
    """One run of the grid: step [rad], KP [N·m/rad] and KV [N·m·s/rad] of the stepped joint."""

    step: float
    kp: float
    kv: float

    @property
    def case(self) -> ControlCase:
        """The control case: G1 in all that the grid does not vary."""
        gains = replace(G1, kp=with_entry(G1.kp, self.kp), kv=with_entry(G1.kv, self.kv))
        return commanded(gains, self.step)


POINTS = tuple(GridPoint(*values) for values in product(STEP_SIZES, KP, KV))
"""All points; KV changes fastest, the step slowest."""


def point_of(case: ControlCase) -> GridPoint:
    """Return where a case stands in the grid."""
    step = round(float(case.q_target[ENTRY]) - START_OF_STEP, 9)  # free of the sum's last bits
    return GridPoint(step, float(case.kp[ENTRY]), float(case.kv[ENTRY]))


CASE_POINTS = {name: point_of(case) for name, case in COMPARED.items()}
"""The points that are the lesson's own cases."""

BOUNDS = {
    "kp": (min(p.kp for p in CASE_POINTS.values()), max(p.kp for p in CASE_POINTS.values())),
    "kv": (min(p.kv for p in CASE_POINTS.values()), max(p.kv for p in CASE_POINTS.values())),
    "step": (0.0, STEP),
}
"""Nothing more violent than the compared cases: smallest and largest value of each axis."""

AGREEMENT = {"rad": 1e-6, "rad/s": 1e-5, "s": 0.0, "N·m": 1e-3, "1": 0.0}
"""By unit: what a run in the batch may differ by from the same case run alone. Times and counts
not at all; a CPU showed 0 rad, 2e-7 rad/s and 6e-5 N·m."""
