"""What the studies around lesson L04 measured, for the stepped joint."""

from robo_genesis.core.orderings import Relation, Value, outcome
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.theory import IdealJoint, step_share

ENGINES = ("Genesis", *study_spec.SECOND_INTEGRATORS)
"""Genesis, and MuJoCo by its integrator."""

GROUP = "readings"
"""Group of a bundle's metrics: what the engines report of the stepped joint without a run."""

UNITS = {
    "passive_damping": "N·m·s/rad",
    **dict.fromkeys(("inertia_Genesis", "inertia_MuJoCo"), "kg·m²"),
    **dict.fromkeys(("gravity_at_start_Genesis", "gravity_at_start_MuJoCo"), "N·m"),
    **{f"gravity_{case}": "N·m" for case in spec.CASES},
}
"""Unit of each. Inertia and `gravity_at_start` are those of the start pose; `gravity` is the effort
that holds the end state of a case."""


def ideal(run: Experiment, case: str) -> IdealJoint:
    """Return the linear joint with a compared case's gains and the inertia of Genesis."""
    gains, readings = study_spec.COMPARED[case], run.readings[GROUP]
    damping = float(gains.kv[spec.ENTRY]) + readings["passive_damping"]
    return IdealJoint(readings["inertia_Genesis"], damping, float(gains.kp[spec.ENTRY]))


def share(run: Experiment, case: str, kind: str = "") -> FloatArray:
    """Return a response as a share of its step: the lesson's, or with `kind` the small one."""
    step = run.traces[f"{case}_{kind}" if kind else case]
    return step_share(step, run.traces[f"{case}_hold"], spec.ENTRY)


def overshoot_by_substeps(run: Experiment, engine: str) -> dict[int, float]:
    """Return G2's overshoot [rad] for each number of substeps, in Genesis or an integrator."""
    names = {n: run_name(engine, "G2", n) for n in study_spec.SUBSTEPS_STUDIED}
    return {n: run.metrics[name].overshoot for n, name in names.items()}


def by_engine(run: Experiment, case: str) -> dict[str, Trace]:
    """Return a compared case's runs at the lesson's solver step, by engine."""
    substeps = study_spec.COMPARED[case].substeps
    return {engine: run.traces[run_name(engine, case, substeps)] for engine in ENGINES}


def compared(run: Experiment, engine: str) -> dict[str, StepMetrics]:
    """Return the metrics of G1 to G3 at the lesson's solver step, in one engine."""
    return {
        name: run.metrics[run_name(engine, name, case.substeps)]
        for name, case in study_spec.COMPARED.items()
    }


def run_name(engine: str, case: str, substeps: int) -> str:
    """Return the name of a run's arrays, in Genesis or by MuJoCo's integrator."""
    if engine == "Genesis":
        declared = study_spec.COMPARED[case].substeps
        return case if substeps == declared else f"{case}_substeps_{substeps}"
    return study_spec.SecondRun(case, engine, substeps).name


def relation_outcome(run: Experiment, engine: str, relation: Relation) -> tuple[str, str]:
    """Return whether an engine's runs show one claimed ordering, and the two values."""
    numbers = {
        f"{case}.{name}": Value(value, unit)
        for case, metrics in compared(run, engine).items()
        for name, value, unit in metrics.items()
    }
    return outcome(numbers, relation)
