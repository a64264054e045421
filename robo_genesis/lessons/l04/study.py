"""What the studies around lesson L04 measured, and the numbers that they are about."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.orderings import Value, outcome
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics, metric_records, step_metrics
from robo_genesis.lessons.l04.theory import IdealJoint, step_share
from robo_genesis.sim.joints import JointMap


@dataclass(frozen=True, slots=True)
class Studies:
    """All that the studies of the lesson look at, for the stepped joint.

    | field | meaning |
    |---|---|
    | `joints` | the map, for names |
    | `traces` | by name: the lesson's cases, and all runs of `l04_studies` |
    | `inertia`, `gravity_at_start` | by engine: [kg·m²] and [N·m] in the start pose |
    | `passive_damping` | of the model's joint [N·m·s/rad] |
    | `gravity` | by case of the lesson: effort that holds its last posture [N·m] |
    """

    joints: JointMap
    traces: Mapping[str, Trace]
    inertia: Mapping[str, float]
    gravity_at_start: Mapping[str, float]
    passive_damping: float
    gravity: Mapping[str, float]

    @property
    def entry(self) -> int:
        """Column of the stepped joint."""
        return self.joints.entry(spec.STEPPED_JOINT)

    def ideal(self, case: str) -> IdealJoint:
        """Return the linear joint with a compared case's gains and the inertia of Genesis."""
        gains = study_spec.COMPARED[case]
        damping = float(gains.kv[self.entry]) + self.passive_damping
        return IdealJoint(self.inertia["Genesis"], damping, float(gains.kp[self.entry]))

    def share(self, case: str, kind: str = "") -> np.ndarray:
        """Return a response as a share of its step: the lesson's, or with `kind` the small one."""
        step = self.traces[f"{case}_{kind}" if kind else case]
        return step_share(step, self.traces[f"{case}_hold"], self.entry)

    def measure(self, name: str) -> StepMetrics:
        """Return the metrics of one run."""
        return step_metrics(self.traces[name], self.entry)

    def overshoot_by_substeps(self, engine: str) -> dict[int, float]:
        """Return G2's overshoot [rad] for each number of substeps, in Genesis or an integrator."""
        names = {n: run_name(engine, "G2", n) for n in study_spec.SUBSTEPS_STUDIED}
        return {n: self.measure(name).overshoot for n, name in names.items()}

    def by_engine(self, case: str) -> dict[str, Trace]:
        """Return a compared case's runs at the lesson's solver step, by engine."""
        substeps = study_spec.COMPARED[case].substeps
        return {engine: self.traces[run_name(engine, case, substeps)] for engine in ENGINES}

    def compared(self, engine: str) -> dict[str, StepMetrics]:
        """Return the metrics of G1 to G3 at the lesson's solver step, in one engine."""
        cases = study_spec.COMPARED
        return {case: step_metrics(self.by_engine(case)[engine], self.entry) for case in cases}


ENGINES = ("Genesis", *study_spec.SECOND_INTEGRATORS)
"""Genesis, and MuJoCo by its integrator."""


def run_name(engine: str, case: str, substeps: int) -> str:
    """Return the name of a run's arrays, in Genesis or by MuJoCo's integrator."""
    if engine == "Genesis":
        declared = study_spec.COMPARED[case].substeps
        return case if substeps == declared else f"{case}_substeps_{substeps}"
    return study_spec.SecondRun(case, engine, substeps).name


def relation_outcome(
    run: Studies, engine: str, relation: tuple[tuple[str, str], str, str, float]
) -> tuple[str, str]:
    """Return whether an engine's runs hold one claimed ordering, and the two values."""
    numbers = {
        f"{case}.{name}": Value(value, unit)
        for case, metrics in run.compared(engine).items()
        for name, value, unit in metrics.items()
    }
    return outcome(numbers, relation)


STEPPED_RUNS = tuple(
    name
    for name in (*study_spec.STEP_CASES, *study_spec.SUBSTEP_CASES, *study_spec.SECOND_RUNS)
    if not name.endswith("_hold")
)
"""The studies' own runs that step: one that holds its start has no metrics of a step."""

READING_UNITS = {
    "inertia": "kg·m²",
    "gravity_at_start": "N·m",
    "gravity": "N·m",
    "passive_damping": "N·m·s/rad",
}
"""Unit of what the engines say of the stepped joint apart from any run."""


def records(run: Studies) -> dict[str, dict[str, dict[str, Any]]]:
    """Return the studies' groups of `metrics.json`: each run's metrics, and what engines said."""
    groups = metric_records({name: run.measure(name) for name in STEPPED_RUNS}, {})
    del groups["model"]
    readings = {"passive_damping": ("passive_damping", run.passive_damping)}
    for what in ("inertia", "gravity_at_start", "gravity"):
        readings |= {f"{what}_{k}": (what, value) for k, value in getattr(run, what).items()}
    return groups | {
        "readings": {
            name: {"value": v, "unit": READING_UNITS[what], "class": "value", "from": ["engine"]}
            for name, (what, v) in readings.items()
        }
    }


def from_readings(
    joints: JointMap, traces: Mapping[str, Trace], readings: Mapping[str, float]
) -> Studies:
    """Return the studies of recorded runs and the recorded `readings` group, by name.

    Raises:
        KeyError: a reading is missing.
    """
    engines = ("Genesis", "MuJoCo")
    return Studies(
        joints=joints,
        traces=traces,
        inertia={name: readings[f"inertia_{name}"] for name in engines},
        gravity_at_start={name: readings[f"gravity_at_start_{name}"] for name in engines},
        passive_damping=readings["passive_damping"],
        gravity={name: readings[f"gravity_{name}"] for name in spec.CASES},
    )
