"""Specification of L04's deeper pages: cases beyond the lab, a grid of steps, tolerances."""

from dataclasses import dataclass, replace
from itertools import product, starmap
from typing import Any, NamedTuple

from robo_genesis.core.experiment import case_inputs
from robo_genesis.core.scene import DT, SUBSTEPS

from .metrics import SETTLING_BAND
from .spec import AT_START, ENTRY, G1, G2, G3, START_OF_STEP, STEP, changed

MEASURES = False

COMPARED = {"G1": G1, "G2": G2, "G3": G3}

# Height of a step whose demand stays below the effort limit with the gains of G1 and G2
# [rad].
SMALL_STEP = 0.005

SMALL_STEPPED = ("G1", "G2")

# Step size is the one factor: a small step, and no step, with the gains of a compared
# case.
STEP_CASES = {
    f"{name}_{kind}": changed(COMPARED[name], q_target=START_OF_STEP + height)
    for name in SMALL_STEPPED
    for kind, height in (("small", SMALL_STEP), ("hold", 0.0))
}

SUBSTEPS_STUDIED = (1, 2, 4, 10, 20, 50)

# Numbers of substeps with which all compared cases run: half the solver step, and a
# tenth.
REFINED = (4, 20)

# The solver's step is the one factor. Each number of substeps needs its own scene.
SUBSTEP_CASES = {
    f"{name}_substeps_{n}": replace(case, substeps=n)
    for n in SUBSTEPS_STUDIED
    for name, case in COMPARED.items()
    if n != SUBSTEPS and (name == "G2" or n in REFINED)
}

EXAMPLE = "example"

# Illustrates the metrics before the comparison: it overshoots, and is not one of the
# cases.
EXAMPLE_CASES = {EXAMPLE: changed(G1, kv=50.0)}

LONGER = "G2_longer"

# The length of the window is the one factor.
LONGER_CASES = {LONGER: replace(G2, steps=2 * G2.steps)}

# Target of a program for the stepped joint [rad]. P1 sends it to the joint's own index,
# P2 to the number in its name.
WANTED = -1.5
INDEX_CASES = {
    "P1": changed(AT_START, q_target=WANTED),
    "P2": changed(AT_START, 4, q_target=WANTED),
}

# Name of the run whose states are assigned, without control and steps
ASSIGNED = "assigned"


@dataclass(frozen=True, slots=True)
class SecondRun:
    """One run in the second engine: a compared case's name, the integrator, substeps."""

    case: str
    integrator: str
    substeps: int

    @property
    def timestep(self) -> float:
        """Length of one solver step [s]."""
        return DT / self.substeps

    @property
    def name(self) -> str:
        """Name of the run's arrays."""
        return f"MuJoCo_{self.integrator}_{self.case}_substeps_{self.substeps}"


SECOND_INTEGRATORS = ("implicitfast", "Euler")

# All compared cases at the lesson's solver step, and G2 at every studied one.
SECOND_RUNS = {
    run.name: run
    for integrator in SECOND_INTEGRATORS
    for run in (
        *(SecondRun(case, integrator, SUBSTEPS) for case in COMPARED),
        *(SecondRun("G2", integrator, n) for n in SUBSTEPS_STUDIED if n != SUBSTEPS),
    )
}

# Heights of the commanded step in the grid [rad].
STEP_SIZES = (0.02, 0.05, 0.1, STEP)

# Gains of the stepped joint in the grid [N·m/rad, N·m·s/rad].
KP = (3500.0, 4375.0, 5250.0, 6125.0, 7000.0)
KV = (100.0, 150.0, 200.0, 250.0, 300.0)


class GridPoint(NamedTuple):
    """One run of the grid: step [rad], KP [N·m/rad] and KV [N·m·s/rad] of the stepped joint."""

    step: float
    kp: float
    kv: float

    @property
    def name(self) -> str:
        """Name of the run's arrays."""
        return f"grid_step_{1000 * self.step:.0f}mrad_KP_{self.kp:.0f}_KV_{self.kv:.0f}"


# All points; KV changes fastest, the step slowest.
POINTS = tuple(starmap(GridPoint, product(STEP_SIZES, KP, KV)))

# The runs of the grid: one batch, one environment for each.
GRID_CASES = {
    point.name: changed(
        G1, kp=point.kp, kv=point.kv, q_target=START_OF_STEP + point.step
    )
    for point in POINTS
}


# The points of the lesson's own cases.
CASE_POINTS = {
    name: GridPoint(STEP, float(case.kp[ENTRY]), float(case.kv[ENTRY]))
    for name, case in COMPARED.items()
}

# What only judges

# Largest motion of another joint, as a share of that of the joint that turns
ALONE = 0.1

# Distance at which a position has left the ideal one [rad]
PARTING_THRESHOLD = SETTLING_BAND

# Speed up to which a run ends nearly at rest [rad/s]. Only at rest can gravity alone
# explain the final error, so this selects the cases that `gravity_support` checks.
AT_REST = 0.01
GRAVITY_AGREEMENT = 0.01  # Share within which KP × final error and gravity agree

# Share within which the readings of the stepped joint agree with the model in MuJoCo;
# the largest difference is 1.1e-4, of gravity at an end.
SAME_MODEL = 3e-4
# Largest difference in overshoot between a model of one joint and a small unsaturated
# step, as a share of the step.
SMALL_STEP_TOLERANCE = 0.03
ONE_JOINT_TOLERANCE = 0.015  # The same of the stepped model and a large step [rad]
# A run is unstable if a joint's effort is clipped in a larger share of samples
CHATTER_SHARE = 0.5
# Largest spread of the engines at the finest step, by that at the lesson's step
SPREAD_SHARE = 0.2

# By unit: largest difference between a run in the batch and the same case run alone.
# Times and counts must be equal. A CPU showed 0 rad, 2e-7 rad/s and 6e-5 N·m.
AGREEMENT = {"rad": 1e-6, "rad/s": 1e-5, "s": 0.0, "N·m": 1e-3, "1": 0.0}


def parameters(page: str) -> dict[str, Any]:
    """Return every configured input of a page's own runs as JSON values, for the evidence key."""
    own = {
        "lecture": {"cases": case_inputs(INDEX_CASES)},
        "motion": {"cases": case_inputs(EXAMPLE_CASES | LONGER_CASES)},
        "formula": {"cases": case_inputs(STEP_CASES)},
        "integrator": {
            "cases": case_inputs(SUBSTEP_CASES),
            "second_runs": case_inputs(SECOND_RUNS),
        },
        "batch": {
            "grid": {"step_rad": list(STEP_SIZES), "kp": list(KP), "kv": list(KV)}
        },
    }
    return {"studies": own[page]}
