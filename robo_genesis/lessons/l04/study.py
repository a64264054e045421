"""What the studies around lesson L04 measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from robo_genesis.core.metrics import case_records, reading_records
from robo_genesis.core.orderings import Relation, Value, outcome
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics, step_metrics
from robo_genesis.lessons.l04.theory import IdealJoint, step_share
from robo_genesis.sim.joints import JointMap


@dataclass(frozen=True, slots=True)
class Studies:
    """Everything that the studies of the lesson read, for the stepped joint.

    | field | meaning |
    |---|---|
    | `joints` | the map, for names |
    | `traces` | by name: the lesson's cases and all runs of the studies |
    | `inertia`, `gravity_at_start` | by engine: [kg·m²] and [N·m] in the start pose |
    | `passive_damping` | of the model's joint [N·m·s/rad] |
    | `gravity` | by case of the lesson: effort that holds its end state [N·m] |
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

    def share(self, case: str, kind: str = "") -> FloatArray:
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
        return {
            name: self.measure(run_name(engine, name, case.substeps))
            for name, case in study_spec.COMPARED.items()
        }


ENGINES = ("Genesis", *study_spec.SECOND_INTEGRATORS)
"""Genesis, and MuJoCo by its integrator."""


def run_name(engine: str, case: str, substeps: int) -> str:
    """Return the name of a run's arrays, in Genesis or by MuJoCo's integrator."""
    if engine == "Genesis":
        declared = study_spec.COMPARED[case].substeps
        return case if substeps == declared else f"{case}_substeps_{substeps}"
    return study_spec.SecondRun(case, engine, substeps).name


def relation_outcome(run: Studies, engine: str, relation: Relation) -> tuple[str, str]:
    """Return whether an engine's runs show one claimed ordering, and the two values."""
    numbers = {
        f"{case}.{name}": Value(value, unit)
        for case, metrics in run.compared(engine).items()
        for name, value, unit in metrics.items()
    }
    return outcome(numbers, relation)


STUDY_RUNS = (*study_spec.STEP_CASES, *study_spec.SUBSTEP_CASES, *study_spec.SECOND_RUNS)
"""The names of the studies' own runs."""

READING_UNITS = {
    "inertia": "kg·m²",
    "gravity_at_start": "N·m",
    "gravity": "N·m",
    "passive_damping": "N·m·s/rad",
}
"""Unit of each value that the engines report of the stepped joint without a run."""


def records(run: Studies) -> dict[str, dict[str, dict[str, Any]]]:
    """Return the studies' groups of `metrics.json`: each run's metrics, and the engines' readings.

    A run that holds its start has no step, so it has no metrics.
    """
    stepped = [name for name in STUDY_RUNS if not name.endswith("_hold")]
    readings = reading_records(
        {"passive_damping": run.passive_damping}, READING_UNITS["passive_damping"]
    )
    for what in ("inertia", "gravity_at_start", "gravity"):
        values = {f"{what}_{name}": value for name, value in getattr(run, what).items()}
        readings |= reading_records(values, READING_UNITS[what])
    return case_records({name: run.measure(name) for name in stepped}) | {"readings": readings}
