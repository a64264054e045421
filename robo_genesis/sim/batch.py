"""Many control cases at once, one in each environment of a batched scene."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.trace import Trace
from robo_genesis.sim import joint_control
from robo_genesis.sim.joint_control import CaseError, ControlCase
from robo_genesis.sim.joints import JointMap, to_numpy


def run_batch(
    scene: Any, robot: Any, joints: JointMap, cases: Mapping[str, ControlCase]
) -> dict[str, Trace]:
    """Do as `joint_control.run_case` does, with each case in an environment of its own.

    Args:
        scene: built with `n_envs` = number of cases, and with `batch_dofs_info`, without which all
            environments share one set of gains.
        robot: the scene's robot.
        joints: its map.
        cases: by name, of equal `dt`, `substeps` and `steps`.

    Raises:
        CaseError: as `reset_batch`.

    Returns:
        The trace of each case by name.
    """
    batch = reset_batch(scene, robot, joints, list(cases.values()))
    q_target = batch.q_target
    dofs = joints.dofs_idx_local.tolist()
    states, steps = [joint_control.read_state(robot, dofs)], []
    start_qd = to_numpy(robot.get_dofs_velocity(dofs))
    robot.control_dofs_position(q_target, dofs)
    start_control_force = to_numpy(robot.get_dofs_control_force(dofs))
    effort_limit = to_numpy(robot.get_dofs_force_range(dofs)[1])
    for _ in range(batch.steps):
        robot.control_dofs_position(q_target, dofs)
        scene.step()
        states.append(joint_control.read_state(robot, dofs))
        steps.append(joint_control.read_step(robot, dofs))
    return {
        name: joint_control.assemble(
            case,
            [tuple(values[k] for values in state) for state in states],
            [tuple(values[k] for values in step) for step in steps],
            [case.q_target] * case.steps,
            start_qd[k],
            start_control_force[k],
            effort_limit[k],
        )
        for k, (name, case) in enumerate(cases.items())
    }


def reset_batch(
    scene: Any, robot: Any, joints: JointMap, cases: Sequence[ControlCase]
) -> ControlCase:
    """Do as `joint_control.reset` does in every environment, and read back what was set.

    Raises:
        CaseError: the scene does not fit the cases, a case must not be run, or a value reads back
            differently from the value that was set.

    Returns:
        The cases as one: its arrays are (cases, joints).
    """
    for case in cases:
        joint_control.validate(case, joints)
    found = (scene.n_envs, scene.dt, scene.substeps)
    required = {(len(cases), case.dt, case.substeps) for case in cases}
    if required != {found} or len({case.steps for case in cases}) != 1:
        raise CaseError(
            f"The scene has (environments, dt, substeps) {found}, the cases require "
            f"{sorted(required)}. Build it with n_envs={len(cases)}, for cases of equal length."
        )
    dofs = joints.dofs_idx_local.tolist()
    arrays: dict[str, Any] = {
        name: np.stack([getattr(case, name) for case in cases])
        for name in ("q_start", "q_target", "kp", "kv", "effort_limit")
    }
    batch = replace(cases[0], **arrays)
    scene.reset()
    robot.set_dofs_kp(batch.kp, dofs)
    robot.set_dofs_kv(batch.kv, dofs)
    robot.set_dofs_force_range(-batch.effort_limit, batch.effort_limit, dofs)
    robot.set_dofs_position(batch.q_start, dofs, zero_velocity=True)
    joint_control.require_read_back(robot, dofs, batch)
    return batch
