"""Specification of the studies around lesson L04: cases beyond the lab, and what they must show."""

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.spec import G1, G2, G3, START_OF_STEP, with_entry
from robo_genesis.sim.joint_control import ControlCase

PAGE = "lecture"
"""The page of the lesson that runs the studies."""

COMPARED = {"G1": G1, "G2": G2, "G3": G3}

PARTING_THRESHOLD = SETTLING_BAND
"""Distance from which a measured position is said to have left the ideal one [rad]."""

SMALL_STEP = 0.005
"""Height of a step whose demand stays below the effort limit with the gains of G1 and G2 [rad]."""


def commanded(case: ControlCase, height: float) -> ControlCase:
    """Return a case in which the height of the stepped joint's step [rad] alone is another."""
    return replace(case, q_target=with_entry(case.q_target, START_OF_STEP + height))


SMALL_STEPPED = ("G1", "G2")
STEP_CASES = {
    f"{name}_{kind}": commanded(COMPARED[name], height)
    for name in SMALL_STEPPED
    for kind, height in (("small", SMALL_STEP), ("hold", 0.0))
}
"""Step size is the one factor: a small step, and no step, with the gains of a compared case."""

SUBSTEPS_STUDIED = (1, 2, 4, 10, 20, 50)
SUBSTEP_CASES = {
    f"G2_substeps_{n}": replace(G2, substeps=n) for n in SUBSTEPS_STUDIED if n != SUBSTEPS
}
"""The solver's step is the one factor: each of these takes a scene of its own, G2 has one."""


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
SECOND_RUNS = {
    run.name: run
    for integrator in SECOND_INTEGRATORS
    for run in (
        *(SecondRun(case, integrator, SUBSTEPS) for case in COMPARED),
        *(SecondRun("G2", integrator, n) for n in SUBSTEPS_STUDIED if n != SUBSTEPS),
    )
}
"""All compared cases at the lesson's solver step, and G2 at every one that is studied."""

SMALL_STEP_TOLERANCE = 0.03
"""What theory and a small unsaturated step may differ by in overshoot, as a share of the step."""

GRAVITY_AGREEMENT = 0.01
"""Share within which KP × final error and gravity are said to agree."""

SAME_MODEL = 1e-3
"""Share within which both engines must give one inertia, and one gravity effort, at the start."""

SPREAD_SHARE = 0.2
"""What must be left, at the finest solver step, of the engines' spread at the lesson's step."""


def parameters() -> dict[str, Any]:
    """Return every configured input of the studies as JSON values, for the evidence key."""
    return {
        "studies": {
            "second_runs": {name: asdict(run) for name, run in SECOND_RUNS.items()},
            "cases": {
                name: {key: np.asarray(value).tolist() for key, value in asdict(case).items()}
                for name, case in (STEP_CASES | SUBSTEP_CASES).items()
            },
        }
    }
