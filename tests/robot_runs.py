"""Runs of robots without Genesis, by the engine's rule of stepping and MuJoCo's mechanics."""

from collections.abc import Sequence
from dataclasses import replace

import mujoco
import numpy as np

from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.engine_kinematics import IkAnswer
from robo_genesis.sim.arm.joint_control import ControlCase, assemble
from robo_genesis.sim.arm.laws import control_law
from robo_genesis.sim.mujoco.kinematics import bare_robot, link_poses

LINKS = (*(f"link{n}" for n in range(8)), "hand", "left_finger", "right_finger")


def solve(target, q, lower, upper, *, iterations, damping, largest=0.5):
    """Return the joint positions (…, 7) that damped least squares reaches from starts (…, 7) [rad].

    Each joint moves by `largest` [rad] at most in one iteration and stays within its
    limits.

    Args:
        target: pose of the hand.
        q: the starts.
        lower: (7,) limits [rad].
        upper: (7,) limits [rad].
        iterations: their number.
        damping: λ of `damped_step`.
        largest: bound of one step [rad].
    """
    for _ in range(iterations):
        step = kinematics.damped_step(
            kinematics.jacobian(q),
            kinematics.pose_error(target, kinematics.hand_pose(q)),
            damping,
        )
        q = np.clip(q + np.clip(step, -largest, largest), lower, upper)
    return q


def answer(position, q_start, iterations) -> IkAnswer:
    """Return what a solver like the engine's answers for a hand that points down."""
    from robo_genesis.lessons.l05.spec import ARM_LIMITS, DOWN

    target = kinematics.Pose(np.asarray(position), DOWN)
    q = solve(target, q_start[:7], *ARM_LIMITS, iterations=iterations, damping=0.01)
    error = kinematics.pose_error(target, kinematics.hand_pose(q))
    return IkAnswer(np.float32([*q, *q_start[7:]]), np.float32(error))


def driven(case: ControlCase, links: Sequence[str], load: float = 0.0) -> Trace:
    """Return a run by semi-implicit Euler with (M + h D) a = f, stored in float32 like others.

    Args:
        case: its target is one for all steps, (d,), or one for each, (n, d).
        links: of the trace.
        load: what is added to the mass of the hand [kg].
    """
    dofs, h = len(case.q_start), case.dt / case.substeps
    commands = np.broadcast_to(case.q_target, (case.steps, dofs))
    of, *_ = bare_robot(load, case.model)
    data = mujoco.MjData(of)
    damping, mass = of.dof_damping, np.zeros((dofs, dofs))
    q, qd, force = np.array(case.q_start), np.zeros(dofs), np.zeros(dofs)
    at = [q]
    first = replace(case, q_target=commands[0])
    efforts = [(qd, control_law(first, q, qd), force)]
    for command in commands:
        now = replace(case, q_target=command)
        for _ in range(case.substeps):
            data.qpos[:], data.qvel[:] = q, qd
            mujoco.mj_fwdPosition(of, data)
            mujoco.mj_fwdVelocity(of, data)
            mujoco.mj_fullM(of, data, mass)
            force = control_law(now, q, qd) - data.qfrc_bias - damping * qd
            qd = qd + h * np.linalg.solve(mass + h * np.diag(damping + case.kv), force)
            q = q + h * qd
        at.append(q)
        efforts.append((qd, control_law(now, q, qd), force))
    return assembled(case, links, at, efforts, commands)


def assembled(case: ControlCase, links: Sequence[str], at, efforts, targets) -> Trace:
    """Return a trace in float32 of positions (n+1, d), with velocity and forces of each."""
    q = np.float32(at)
    readings = zip(
        q, *link_poses(q, links, case.model), *zip(*efforts, strict=True), strict=True
    )
    kept = [tuple(map(np.float32, reading)) for reading in readings]
    return assemble(case, kept, targets, np.float32(case.effort_limit))


def assigned(
    case: ControlCase, links: Sequence[str], before: Trace, postures=None
) -> Trace:
    """Return the states of a straight line, as `assign_path` does, or those of postures (n, d).

    `before` is the run whose last internal force remains.
    """
    path = np.linspace(case.q_start, case.q_target, case.steps + 1)
    path = path if postures is None else np.vstack([case.q_start, postures])
    efforts = np.zeros((len(path), 3, len(case.q_start)))
    efforts[:, 2] = before.internal_force[-1]
    return assembled(case, links, path, efforts, path[1:])
