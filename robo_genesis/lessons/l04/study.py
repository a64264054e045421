"""What lesson L04 measured beyond its lab, for the stepped joint."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.comparison import Relation, Value, outcome
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import dynamics
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joint_control import ControlCase, run_case
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

from . import spec, study_spec
from .metrics import StepMetrics, is_saturated, step_metrics
from .spec import ENTRY
from .theory import IdealJoint, overshoot_share, step_share, stepped_joint

# Genesis, and MuJoCo by its integrator.
ENGINES = ("Genesis", *study_spec.SECOND_INTEGRATORS)

# The lesson's number of solver steps, and the length of one [s].
SUBSTEPS, H = spec.G1.substeps, spec.G1.dt / spec.G1.substeps

# Velocity gains of the compared cases [N·m·s/rad].
COMPARED_KV = sorted({case.kv[ENTRY] for case in study_spec.COMPARED.values()})

# Group of a bundle's metrics: what the engines report of the stepped joint without a
# run.
GROUP = "readings"

# What Genesis reports of the start pose, with units. Gravity is the effort that holds
# it.
AT_START = {
    "passive_damping": "N·m·s/rad",
    "inertia_Genesis": "kg·m²",
    "gravity_at_start_Genesis": "N·m",
}

# Entry of the mass matrix at the start while a position is commanded with this KV.
MASSES = {f"mass_KV_{kv:g}": "kg·m²" for kv in COMPARED_KV}

# Effort that holds the end state of a case.
GRAVITY = {f"gravity_{case}": "N·m" for case in spec.CASES}


def measure(trace: Trace, case: ControlCase) -> StepMetrics:
    """Return the metrics of the stepped joint."""
    return step_metrics(trace, ENTRY)


def of_joint(values: Mapping[str, FloatArray]) -> dict[str, float]:
    """Return the stepped joint's entry of each array (d,)."""
    return {name: float(array[ENTRY]) for name, array in values.items()}


def read_start(scene: Any, robot: Any, joints: JointMap) -> dict[str, float]:
    """Read passive damping, inertia and gravity effort at the start, in Genesis."""
    q, dofs = spec.BASELINE.q_start, joints.dofs
    return of_joint(
        {
            "passive_damping": dynamics.passive_damping(robot, dofs),
            "inertia_Genesis": dynamics.effective_inertia(scene, robot, joints, q),
            "gravity_at_start_Genesis": dynamics.gravity_effort(
                scene, robot, joints, q
            ),
        }
    )


def read_masses(scene: Any, robot: Any, joints: JointMap) -> dict[str, float]:
    """Read the mass matrix at the start while a position is commanded, for each KV, in Genesis."""
    found = {}
    for case in (spec.G1, spec.G3):
        run_case(scene, robot, joints, replace(case, q_target=case.q_start, steps=1))
        masses = dynamics.mass_diagonal(robot, joints.dofs)
        found[f"mass_KV_{case.kv[ENTRY]:g}"] = float(masses[ENTRY])
    return found


def read_gravity(
    scene: Any, robot: Any, joints: JointMap, traces: Mapping[str, Trace]
) -> dict[str, float]:
    """Read the gravity effort at the end state of each case, in Genesis."""
    return of_joint(
        {
            f"gravity_{name}": dynamics.gravity_effort(
                scene, robot, joints, traces[name].q[-1]
            )
            for name in spec.CASES
        }
    )


def by_model(traces: Mapping[str, Trace]) -> dict[str, float]:
    """Return every value of `GROUP` by the model in MuJoCo."""
    inertia, gravity, damping = mujoco_kinematics.at_rest(spec.G1.q_start)
    found = dict(zip(AT_START, (damping, inertia, gravity), strict=True))
    for kv in COMPARED_KV:
        found[f"mass_KV_{kv:g}"] = inertia + H * (damping + kv)
    for name in spec.CASES:
        end = traces[name].q[-1]
        found[f"gravity_{name}"] = mujoco_kinematics.gravity_effort(end)
    return of_joint(found)


def implicit_term(run: Experiment, kv: float) -> float:
    """Return what the engine's integrator adds to the inertia of the stepped joint [kg·m²]."""
    return H * (run.readings[GROUP]["passive_damping"] + kv)


def without_term(run: Experiment, kv: float) -> float:
    """Return the mass read while a position was commanded, less the integrator's term [kg·m²]."""
    return run.readings[GROUP][f"mass_KV_{kv:g}"] - implicit_term(run, kv)


def damping_ratio(case: str) -> FloatArray:
    """Return h (KV + d) / I of each joint (d,) at the start, by the model in MuJoCo."""
    settings = study_spec.COMPARED[case]
    inertia, _, damping = mujoco_kinematics.at_rest(settings.q_start)
    return H * (settings.kv + damping) / inertia


def ideal(run: Experiment, case: str) -> IdealJoint:
    """Return the linear joint with a compared case's gains and the inertia of Genesis."""
    gains, readings = study_spec.COMPARED[case], run.readings[GROUP]
    damping = gains.kv[ENTRY] + readings["passive_damping"]
    return IdealJoint(readings["inertia_Genesis"], damping, gains.kp[ENTRY])


def share(run: Experiment, case: str, kind: str = "") -> FloatArray:
    """Return a response as a share of its step: the lesson's, or with `kind` the small one."""
    step = run.traces[f"{case}_{kind}" if kind else case]
    return step_share(step, run.traces[f"{case}_hold"], ENTRY)


def off_ideal(run: Experiment, case: str, kind: str = "") -> float:
    """Return the largest distance of such a response from the ideal joint's, as a share."""
    response = ideal(run, case).response(run.traces[case].t)
    return float(np.abs(share(run, case, kind) - response).max())


def supports(run: Experiment, case: str) -> tuple[float, float]:
    """Return KP × final error of a case, and the gravity effort at its end [N·m]."""
    kp = spec.CASES[case].kp[ENTRY]
    return kp * run.metrics[case].final_error, run.readings[GROUP][f"gravity_{case}"]


def model_overshoot(run: Experiment, case: str, height: float) -> float:
    """Return the overshoot of the stepped model of one joint at the run's samples [rad].

    A step of the lesson's height has the force limit and gravity: the mean of the
    efforts that hold start and end of the case. A smaller step has neither.
    """
    gains, readings = study_spec.COMPARED[case], run.readings[GROUP]
    limit, gravity = np.inf, 0.0
    if height >= spec.STEP:
        limit = gains.effort_limit[ENTRY]
        gravity = (
            readings["gravity_at_start_Genesis"] + readings[f"gravity_{case}"]
        ) / 2
    passive, n = readings["passive_damping"], gains.steps * SUBSTEPS
    path = stepped_joint(ideal(run, case), passive, height, H, n, limit, gravity)
    return float(max(0.0, path[::SUBSTEPS].max()))


def overshoots(run: Experiment, case: str, height: float) -> tuple[float, float, float]:
    """Return the overshoots [rad] of the ideal joint, of the stepped model and of Genesis.

    The last is that of a difference of two runs for the small step, and the metric for
    the other.
    """
    found = run.metrics[case].overshoot
    if height < spec.STEP:
        found = overshoot_share(share(run, case, "small")) * height
    return (
        ideal(run, case).overshoot * height,
        model_overshoot(run, case, height),
        found,
    )


def distance_from_ideal(run: Experiment, case: str) -> FloatArray:
    """Return the distance of a case from the ideal joint at each state, (n+1,) [rad]."""
    trace = run.traces[case]
    q = trace.q[:, ENTRY].astype(float)
    step = study_spec.COMPARED[case].q_target[ENTRY] - q[0]
    return np.abs(q - q[0] - step * ideal(run, case).response(trace.t))


def at_limit_until(trace: Trace) -> float:
    """Return the time [s] to which the stepped joint's effort stays at the limit of its start.

    It is 0 if the effort is below the limit at t = 0 or at the first sample.
    """
    limit, force = trace.effort_limit[ENTRY], trace.control_force[:, ENTRY]
    forces = np.append(trace.start_control_force[ENTRY], force)
    held = is_saturated(forces, limit) & (np.sign(forces) == np.sign(forces[0]))
    return trace.t[max(0, int(np.append(held, False).argmin()) - 1)]


def braking_error(trace: Trace) -> float:
    """Return how far the stepped joint is from its target when its effort first brakes [rad].

    It is 0 for an effort that never brakes.
    """
    brakes = trace.control_force[:, ENTRY] < 0
    left = (trace.target - trace.q[1:])[:, ENTRY]
    return left[brakes.argmax()] * brakes.any()


def unstable_joints(trace: Trace) -> list[str]:
    """Name the joints with a clipped effort in so many samples that the run is called unstable."""
    share = is_saturated(trace.control_force, trace.effort_limit).mean(axis=0)
    return [JOINT_NAMES[k] for k in np.flatnonzero(share > study_spec.CHATTER_SHARE)]


# By engine


def run_name(engine: str, case: str, substeps: int = SUBSTEPS) -> str:
    """Return the name of a compared case's run, in Genesis or by MuJoCo's integrator."""
    if engine == "Genesis":
        return case if substeps == SUBSTEPS else f"{case}_substeps_{substeps}"
    return study_spec.SecondRun(case, engine, substeps).name


def compared(
    run: Experiment, engine: str, substeps: int = SUBSTEPS
) -> dict[str, StepMetrics]:
    """Return the metrics of G1 to G3 in one engine."""
    return {
        case: run.metrics[run_name(engine, case, substeps)]
        for case in study_spec.COMPARED
    }


def unstable(run: Experiment, engine: str, substeps: int = SUBSTEPS) -> bool:
    """Return whether a run of an engine is unstable: of G1 to G3, or of G2 with other substeps."""
    cases = study_spec.COMPARED if substeps == SUBSTEPS else ("G2",)
    return any(
        unstable_joints(run.traces[run_name(engine, case, substeps)]) for case in cases
    )


def overshoot_by_substeps(run: Experiment, engine: str) -> dict[int, float]:
    """Return G2's overshoot [rad] for each number of substeps."""
    numbers = study_spec.SUBSTEPS_STUDIED
    return {n: run.metrics[run_name(engine, "G2", n)].overshoot for n in numbers}


def spread(run: Experiment, substeps: int) -> float:
    """Return how far the stable engines' overshoots of G2 differ [rad]."""
    stable = [
        run.metrics[run_name(engine, "G2", substeps)].overshoot
        for engine in ENGINES
        if not unstable(run, engine, substeps)
    ]
    return np.ptp(stable)


def relation_outcome(
    run: Experiment, engine: str, relation: Relation, substeps: int = SUBSTEPS
) -> tuple[str, str]:
    """Return whether an engine's runs show one claimed ordering, and the two values."""
    values = {
        f"{case}.{name}": Value(value, unit)
        for case, found in compared(run, engine, substeps).items()
        for name, value, unit in found.items()
    }
    return outcome(values, relation)
