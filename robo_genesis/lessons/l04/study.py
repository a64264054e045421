"""What lesson L04 measured beyond its lab, for the stepped joint."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.comparison import Relation, Value, outcome
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics, is_saturated, step_metrics
from robo_genesis.lessons.l04.theory import IdealJoint, step_share, stepped_joint
from robo_genesis.sim.arm import dynamics
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joint_control import ControlCase, run_case
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.mujoco import joints as mujoco_joints

ENGINES = ("Genesis", *study_spec.SECOND_INTEGRATORS)
"""Genesis, and MuJoCo by its integrator."""

COMPARED_KV = sorted({float(case.kv[spec.ENTRY]) for case in study_spec.COMPARED.values()})
"""Velocity gains of the compared cases [N·m·s/rad]."""

GROUP = "readings"
"""Group of a bundle's metrics: what the engines report of the stepped joint without a run."""

AT_START = {
    "passive_damping": "N·m·s/rad", "inertia_Genesis": "kg·m²", "gravity_at_start_Genesis": "N·m",
}  # fmt: skip
"""What Genesis reports of the start pose, with units. Gravity is the effort that holds it."""

IN_MUJOCO = {"inertia_MuJoCo": "kg·m²", "gravity_at_start_MuJoCo": "N·m"}
"""The same in MuJoCo."""

MASSES = {f"mass_KV_{kv:g}": "kg·m²" for kv in COMPARED_KV}
"""Entry of the mass matrix at the start while a position is commanded with this KV."""

GRAVITY = {f"gravity_{case}": "N·m" for case in spec.CASES}
"""Effort that holds the end state of a case."""


def measure(trace: Trace, case: ControlCase) -> StepMetrics:
    """Return the metrics of the stepped joint."""
    return step_metrics(trace, spec.ENTRY)


def read_start(scene: Any, robot: Any, joints: JointMap) -> dict[str, float]:
    """Read passive damping, inertia and gravity effort at the start, in Genesis."""
    k, dofs = joints.entry(spec.STEPPED_JOINT), joints.dofs_idx_local.tolist()
    q = spec.BASELINE.q_start
    return {
        "passive_damping": float(dynamics.passive_damping(robot, dofs)[k]),
        "inertia_Genesis": float(dynamics.effective_inertia(scene, robot, joints, q)[k]),
        "gravity_at_start_Genesis": float(dynamics.gravity_effort(scene, robot, joints, q)[k]),
    }


def read_masses(scene: Any, robot: Any, joints: JointMap) -> dict[str, float]:
    """Read the mass matrix at the start while a position is commanded, for each KV, in Genesis."""
    k, dofs = joints.entry(spec.STEPPED_JOINT), joints.dofs_idx_local.tolist()
    found = {}
    for kv in COMPARED_KV:
        case = next(of for of in study_spec.COMPARED.values() if of.kv[spec.ENTRY] == kv)
        run_case(scene, robot, joints, replace(case, q_target=case.q_start, steps=1))
        found[f"mass_KV_{kv:g}"] = float(dynamics.mass_diagonal(robot, dofs)[k])
    return found


def read_gravity(
    scene: Any, robot: Any, joints: JointMap, traces: Mapping[str, Trace]
) -> dict[str, float]:
    """Read the gravity effort at the end state of each case, in Genesis."""
    k = joints.entry(spec.STEPPED_JOINT)
    return {
        f"gravity_{name}": float(
            dynamics.gravity_effort(scene, robot, joints, traces[name].q[-1])[k]
        )
        for name in spec.CASES
    }


def read_second_engine() -> dict[str, float]:
    """Read inertia and gravity effort at the start in MuJoCo."""
    inertia, gravity = mujoco_joints.at_rest(spec.BASELINE, spec.BASELINE.q_start)
    return {
        "inertia_MuJoCo": float(inertia[spec.ENTRY]),
        "gravity_at_start_MuJoCo": float(gravity[spec.ENTRY]),
    }


def implicit_term(run: Experiment, kv: float) -> float:
    """Return what the engine's integrator adds to the inertia of the stepped joint [kg·m²]."""
    return spec.G1.dt / spec.G1.substeps * (run.readings[GROUP]["passive_damping"] + kv)


def without_term(run: Experiment, kv: float) -> float:
    """Return the mass read while a position was commanded, less the integrator's term [kg·m²]."""
    return run.readings[GROUP][f"mass_KV_{kv:g}"] - implicit_term(run, kv)


def damping_ratio(case: str) -> FloatArray:
    """Return h (KV + d) / I of each joint (d,) at the start, by the model in MuJoCo."""
    settings = study_spec.COMPARED[case]
    inertia, _ = mujoco_joints.at_rest(settings, settings.q_start)
    damping = mujoco_joints.passive_damping(settings)
    return np.asarray(settings.dt / settings.substeps * (settings.kv + damping) / inertia)


def same_beginning(short: Trace, long: Trace) -> bool:
    """Return whether the longer run begins with exactly the samples of the shorter one."""
    n = short.steps
    return (
        long.steps > n
        and np.array_equal(short.q, long.q[: n + 1])
        and np.array_equal(short.qd, long.qd[:n])
        and np.array_equal(short.control_force, long.control_force[:n])
    )


def ideal(run: Experiment, case: str) -> IdealJoint:
    """Return the linear joint with a compared case's gains and the inertia of Genesis."""
    gains, readings = study_spec.COMPARED[case], run.readings[GROUP]
    damping = float(gains.kv[spec.ENTRY]) + readings["passive_damping"]
    return IdealJoint(readings["inertia_Genesis"], damping, float(gains.kp[spec.ENTRY]))


def share(run: Experiment, case: str, kind: str = "") -> FloatArray:
    """Return a response as a share of its step: the lesson's, or with `kind` the small one."""
    step = run.traces[f"{case}_{kind}" if kind else case]
    return step_share(step, run.traces[f"{case}_hold"], spec.ENTRY)


def stepped(run: Experiment, case: str, height: float) -> FloatArray:
    """Return the distance of the stepped joint (n+1,) from the target [rad], sampled as the run.

    A step of the lesson's height has the force limit and gravity: the mean of the efforts that hold
    start and end of the case. A smaller step has neither.
    """
    gains, readings = study_spec.COMPARED[case], run.readings[GROUP]
    h, steps = gains.dt / gains.substeps, gains.steps * gains.substeps
    clipped = height >= spec.STEP
    gravity = (readings["gravity_at_start_Genesis"] + readings[f"gravity_{case}"]) / 2
    path = stepped_joint(
        ideal(run, case), readings["passive_damping"], height, h, steps,
        limit=float(gains.effort_limit[spec.ENTRY]) if clipped else np.inf,
        gravity=gravity if clipped else 0.0,
    )  # fmt: skip
    return np.asarray(path[:: gains.substeps])


def stepped_overshoot(run: Experiment, case: str, height: float) -> float:
    """Return the overshoot of the model of one joint [rad]."""
    return float(max(0.0, stepped(run, case, height).max()))


def unstable_joints(trace: Trace) -> list[str]:
    """Name the joints with a clipped effort in so many samples that the run is called unstable."""
    share = is_saturated(trace.control_force, trace.effort_limit).mean(axis=0)
    return [JOINT_NAMES[k] for k in np.flatnonzero(share > study_spec.CHATTER_SHARE)]


def unstable(run: Experiment, engine: str, substeps: int = spec.G2.substeps) -> bool:
    """Return whether a run of an engine is unstable: of G1 to G3, or of G2 with other substeps."""
    cases = study_spec.COMPARED if substeps == spec.G2.substeps else ("G2",)
    return any(unstable_joints(run.traces[run_name(engine, case, substeps)]) for case in cases)


def spread(run: Experiment, substeps: int) -> float:
    """Return how far the stable engines' overshoots of G2 differ [rad]."""
    engines = (engine for engine in ENGINES if not unstable(run, engine, substeps))
    values = [overshoot_by_substeps(run, engine)[substeps] for engine in engines]
    return max(values) - min(values)


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
