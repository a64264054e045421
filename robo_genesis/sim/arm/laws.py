"""What the arrays of a position-controlled robot have in common, by the mechanics of its model.

The poses of the links are a function of the positions, the control force is the control
law, and the internal force is the net force at the state before the last solver step.
MuJoCo computes poses, masses and gravity of the same model file in float64. What
computes them is imported where it is used: a page measures without it. Forces grow with
KP, and so do their tolerances from `STIFF` on.

| tolerance | residual of the CPU runs | value |
|---|---|---|
| `LIMIT_TOLERANCE` of a start | 5e-8 rad | 1e-6 rad |
| `LAW`, control force: float32 in KP times a position error | 4e-4 N·m | 4e-3 N·m |
| `POSE`, link positions and quaternions | 2.3e-7 m, 2.2e-7 | 2.5e-6 |
| `NET_FORCE`, internal force of a joint, and of a finger | 9e-4 N·m, 6e-3 N | 1e-2, 6e-2 |
| `STEPPED`, velocity before the last solver step | 2e-4 rad/s | 2e-3 rad/s |
| `NEXT`, position and velocity after one outer step in MuJoCo | 2e-7 rad, 6e-5 rad/s | 2e-6, 6e-4 |
| `MEAN`, mean velocity beyond those of the two samples | 0.07 rad/s | 0.7 rad/s |
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from robo_genesis.core.checks import Finding
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.franka import FRANKA
from robo_genesis.sim.arm.joint_control import LIMIT_TOLERANCE, ControlCase
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.arm.model import RobotModel
from robo_genesis.sim.laws import (
    ZERO,
    apart,
    broken,
    mean_speed,
    times,
    unit_quaternions,
)

MEASURES = False

LAW, POSE, STEPPED, MEAN, NEXT = 4e-3, 2.5e-6, 2e-3, 0.7, (2e-6, 6e-4)

# Tolerance of the internal force of a joint and of a finger [N·m or N]. Fingers also
# have a force between them, which the rule does not know.
NET_FORCE = (1e-2, 6e-2)

# KP up to which rounding of a position stays within the tolerances [N·m/rad or N/m]
STIFF = 1e4


def driven_run(
    trace: Trace,
    case: ControlCase,
    links: Sequence[str],
    net_force: FloatArray | None = None,
    load: float = 0.0,
) -> Iterator[Finding]:
    """Yield what no run of `joint_control.run_case` has.

    Args:
        trace: the run.
        case: its settings; the target is one for all steps, (d,), or one for each, (n,
            d).
        links: names of the links of the trace.
        net_force: (d,) tolerances of the internal force [N·m or N], `NET_FORCE` by
            default.
        load: what is added to the mass of the hand [kg].

    Raises:
        ModelError: MuJoCo cannot read the robot's model, or its base moves freely.
    """
    yield from commanded(trace, case, links)
    yield from dynamics(trace, case, net_force, load)


def commanded(
    trace: Trace, case: ControlCase, links: Sequence[str]
) -> Iterator[Finding]:
    """Yield what no run with a commanded target has, whatever engine steps; arguments as before.

    Of a robot whose base moves freely nothing is known about where its links are.
    """
    if trace.q.shape[1] != len(case.model.joints):
        expected = f"{len(case.model.joints)}, those of {case.model.file}"
        yield broken("labels", "number of DOFs", trace.q.shape[1], expected)
        return
    yield from times(trace, case.steps, case.dt)
    yield from start_and_limits(trace, case)
    yield from apart("start", "target [rad or m]", trace.target, case.q_target, 0.0)
    first = replace(case, q_target=np.atleast_2d(case.q_target)[0])
    start, room = control_law(first, trace.q[0], trace.start_qd), LAW * softer(case)
    found = trace.start_control_force
    yield from apart("law", "start_control_force [N·m or N]", found, start, room)
    law = control_law(case, trace.q[1:], trace.qd)
    yield from apart("law", "control_force [N·m or N]", trace.control_force, law, room)
    if case.model.free_base:
        yield from unit_quaternions(trace.link_quat)
    else:
        yield from poses(trace, links, case.model)


def assigned_path(
    trace: Trace, case: ControlCase, links: Sequence[str], runs: Iterable[Trace]
) -> Iterator[Finding]:
    """Yield what no run of `joint_control.assign_path` has; the arguments are as below."""
    yield from assigned_postures(trace, case, links, runs)
    path = np.linspace(case.q_start, case.q_target, case.steps + 1)[1:]
    yield from apart("start", "target [rad or m]", trace.target, path, 0.0)


def assigned_postures(
    trace: Trace, case: ControlCase, links: Sequence[str], runs: Iterable[Trace]
) -> Iterator[Finding]:
    """Yield what no run of `joint_control.assign_postures` has; the arguments are as before.

    Nothing is stepped, so the internal force remains that of the step before: it is the
    last of one of the page's `runs` whose force changes.
    """
    yield from times(trace, case.steps, case.dt)
    yield from start_and_limits(trace, case)
    yield from apart(
        "start", "q [rad or m]", trace.q[1:], trace.target, LIMIT_TOLERANCE
    )
    yield from apart("motion", "qd [rad/s or m/s]", trace.qd, ZERO, 0.0)
    yield from apart("law", "control_force [N·m or N]", trace.control_force, ZERO, 0.0)
    yield from apart(
        "law", "start_control_force [N·m or N]", trace.start_control_force, ZERO, 0.0
    )
    ends = [
        of.internal_force[-1] for of in runs if np.ptp(of.internal_force, axis=0).any()
    ]
    ends = ends or [trace.internal_force[0]]
    force = min(ends, key=lambda end: float(np.abs(trace.internal_force - end).max()))
    yield from apart(
        "motion", "internal_force [N·m or N]", trace.internal_force, force, 0.0
    )
    yield from poses(trace, links, case.model)


def start_and_limits(trace: Trace, case: ControlCase) -> Iterator[Finding]:
    """Yield a start that is not the case's, or not at rest, and an effort limit of another case."""
    yield from apart(
        "start", "start of q [rad or m]", trace.q[0], case.q_start, LIMIT_TOLERANCE
    )
    yield from apart("start", "start_qd [rad/s or m/s]", trace.start_qd, ZERO, 0.0)
    limit, name = case.effort_limit, "effort_limit [N·m or N]"
    yield from apart(
        "law", name, trace.effort_limit, limit, LIMIT_TOLERANCE * (1 + limit / 10)
    )


def control_law(case: ControlCase, q: FloatArray, qd: FloatArray) -> FloatArray:
    """Return clip(KP (q_target − q) − KV q̇) of states (…, d) [N·m or N]."""
    effort = case.kp * (case.q_target - q) - case.kv * qd
    return np.asarray(np.clip(effort, -case.effort_limit, case.effort_limit))


def softer(case: ControlCase) -> FloatArray:
    """Return by how much tolerances of forces (d,) grow, because KP multiplies rounding."""
    return np.maximum(1.0, case.kp / STIFF)


def poses(trace: Trace, links: Sequence[str], of: RobotModel) -> Iterator[Finding]:
    """Yield a link that is not where the positions of the joints put it."""
    from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

    unknown = sorted(set(links) - mujoco_kinematics.link_names(of))
    if unknown:
        yield broken("pose", "list of links that the model does not have", unknown, [])
        return
    position, orientation = mujoco_kinematics.link_poses(trace.q, links, of)
    yield from apart("pose", "link_pos [m]", trace.link_pos, position, POSE)
    same = (orientation * trace.link_quat).sum(
        -1, keepdims=True
    ) >= 0  # −q is the rotation q
    expected = np.where(same, orientation, -orientation)
    yield from apart("pose", "link_quat", trace.link_quat, expected, POSE)


def model_joints(joints: JointMap, of: RobotModel = FRANKA) -> Iterator[Finding]:
    """Yield an index, a limit or a type that the joint of the model does not have."""
    from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

    model, _, q_at, dof_at = mujoco_kinematics.bare_robot(of=of)
    own = [model.joint(name).id for name in joints.names]
    limited = model.jnt_limited[own][:, None].astype(bool)
    lower, upper = np.where(limited, model.jnt_range[own], (-np.inf, np.inf)).T
    expected = {
        "dofs_idx_local": dof_at,
        "qs_idx_local": q_at,
        "lower": lower,
        "upper": upper,
    }
    for name, values in expected.items():
        found, valid = map(
            np.nan_to_num, (getattr(joints, name), np.array(values))
        )  # of ±∞
        yield from apart("labels", name, found, valid, LIMIT_TOLERANCE)
    types = tuple(mujoco_kinematics.TYPES[kind] for kind in model.jnt_type[own])
    if joints.types != types:
        yield broken("labels", "list of types", joints.types, types)


def dynamics(
    trace: Trace,
    case: ControlCase,
    net_force: FloatArray | None = None,
    load: float = 0.0,
) -> Iterator[Finding]:
    """Yield an internal force that is not the net force, and motion that the samples do not have.

    `net_force` and `load` are as of `driven_run`.

    Semi-implicit Euler gives the state before the last solver step from the state after
    it: the position is q − h q̇, and the velocity is q̇ − h a with (M + h D) a = f, the
    internal force, where D are passive damping and KV. The net force there is control
    force − bias − passive damping.
    """
    from robo_genesis.sim.mujoco.kinematics import unknown_forces

    if others := unknown_forces(case.model):
        yield broken(
            "motion", f"list of forces of {case.model.file} without a law", others, []
        )
        return
    if net_force is None:
        net_force = np.repeat(NET_FORCE, (case.model.arm, case.model.fingers)) * softer(
            case
        )
    h, n = case.dt / case.substeps, case.substeps
    speeds = np.vstack([trace.start_qd, trace.qd]).astype(np.float64)
    q = trace.q.astype(np.float64)
    q_before = q[1:] - h * speeds[1:]
    qd_before, force = last_step(trace, case, q_before, load)
    name = "internal_force [N·m or N]"
    yield from apart("motion", name, trace.internal_force, force, net_force)
    if n <= 2:  # then the step began at a sample, or the only other step did
        middle = (q_before - q[:-1]) / h if n == 2 else speeds[:-1]
        name = "velocity before the last solver step [rad/s or m/s]"
        yield from apart("motion", name, qd_before, middle, STEPPED)
    yield from mean_speed(q, speeds, case.dt, MEAN)


def last_step(
    trace: Trace, case: ControlCase, q_before: FloatArray, load: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Return velocity and net force, each (n, d), at the positions (n, d) before the last step."""
    import mujoco

    from robo_genesis.sim.mujoco.kinematics import bare_robot

    (model, data, q_at, dof_at), h = (
        bare_robot(load, case.model),
        case.dt / case.substeps,
    )
    damping, diagonal = model.dof_damping[dof_at], model.M_rowadr + model.M_rownnz - 1
    states, impulses, speeds, bias = np.zeros((4, len(q_before), model.nv))
    states[:, q_at], speeds[:, dof_at] = q_before, trace.qd
    impulses[:, dof_at] = -h * trace.internal_force.astype(np.float64)
    qpos, qvel, mass, solved = data.qpos, data.qvel, data.M, np.zeros((1, model.nv))
    change = solved[0]
    implicit = np.zeros(mass.shape)
    implicit[diagonal[dof_at]] = h * (damping + case.kv)
    for state, impulse, speed, effort in zip(
        states, impulses[:, None], speeds, bias, strict=True
    ):
        qpos[:] = state
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mass += implicit
        mujoco.mj_factorM(model, data)
        mujoco.mj_solveM(model, data, solved, impulse)
        speed += change
        qvel[:] = speed
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 0, effort)
    velocity = speeds[:, dof_at]
    control = control_law(case, q_before, velocity)
    return velocity, control - bias[:, dof_at] - damping * velocity


def driven_in_mujoco(
    trace: Trace,
    case: ControlCase,
    links: Sequence[str],
    timestep: float,
    integrator: str,
) -> Iterator[Finding]:
    """Yield what no run of `mujoco_joints.run_case` has; the arguments are as there.

    Each state follows from the state before it. A whole run is not comparable on
    another CPU where the integrator is nearly unstable: there the rounding of float64
    grows to 0.6 rad/s.
    """
    from robo_genesis.sim.mujoco import joints as mujoco_joints

    yield from commanded(trace, case, links)
    q, qd, force = mujoco_joints.each_step(trace, case, timestep, integrator)
    yield from apart("motion", "q [rad or m]", trace.q[1:], q, NEXT[0])
    yield from apart("motion", "qd [rad/s or m/s]", trace.qd, qd, NEXT[1])
    name = "internal_force [N·m or N]"
    room = np.repeat(NET_FORCE, (case.model.arm, case.model.fingers))
    yield from apart("motion", name, trace.internal_force, force, room)
