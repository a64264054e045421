"""Many control cases at once, one in each environment of a batched scene, and their results."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import StepMetrics, step_metrics
from robo_genesis.lessons.l04.spec import STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import GridPoint
from robo_genesis.sim import joint_control
from robo_genesis.sim.joint_control import CaseError, ControlCase
from robo_genesis.sim.joints import JointMap, to_numpy


@dataclass(frozen=True, slots=True)
class Sweep:
    """Results of the stepped joint at p points, in runs of n steps.

    | field | shape | meaning |
    |---|---|---|
    | `points` | (p,) | gains and step of each run |
    | `cases` | (p,) | the complete case of each run |
    | `t` | (n+1,) | time of each state [s] |
    | `q` | (p, n+1) | position [rad] |
    | `control_force` | (p, n) | control force after each step, at t[1] … t[n] [N·m] |
    | `effort_limit` | (p,) | limit read back [N·m] |
    | `metrics` | (p,) | of each run |
    """

    points: tuple[GridPoint, ...]
    cases: tuple[ControlCase, ...]
    t: FloatArray
    q: FloatArray
    control_force: FloatArray
    effort_limit: FloatArray
    metrics: tuple[StepMetrics, ...]

    def at(self, point: GridPoint) -> int:
        """Return the number of a point.

        Raises:
            ValueError: the grid does not have it.
        """
        return self.points.index(point)


def sweep(scene: Any, robot: Any, joints: JointMap, points: Sequence[GridPoint]) -> Sweep:
    """Run every point in its own environment and keep the stepped joint's results."""
    return collect(points, run_batch(scene, robot, joints, [p.case for p in points]), joints)


def collect(points: Sequence[GridPoint], traces: Sequence[Trace], joints: JointMap) -> Sweep:
    """Return the stepped joint's part of the points' traces, with its metrics."""
    k = joints.entry(STEPPED_JOINT)
    results = Sweep(
        points=tuple(points),
        cases=tuple(point.case for point in points),
        t=traces[0].t,
        q=np.stack([trace.q[:, k] for trace in traces]),
        control_force=np.stack([trace.control_force[:, k] for trace in traces]),
        effort_limit=np.stack([trace.effort_limit[k] for trace in traces]),
        metrics=tuple(step_metrics(trace, k) for trace in traces),
    )
    for array in (results.q, results.control_force, results.effort_limit):
        array.setflags(write=False)
    return results


def run_batch(
    scene: Any, robot: Any, joints: JointMap, cases: Sequence[ControlCase]
) -> list[Trace]:
    """Do as `joint_control.run_case` does, with case k in environment k.

    Args:
        scene: built with `n_envs` = number of cases, and with `batch_dofs_info`, without which all
            environments share one set of gains.
        robot: the scene's robot.
        joints: its map.
        cases: of equal `dt`, `substeps` and `steps`.

    Raises:
        CaseError: as `reset_batch`.

    Returns:
        A trace for each case.
    """
    q_target = reset_batch(scene, robot, joints, cases).q_target
    dofs = joints.dofs_idx_local.tolist()
    states, steps = [joint_control.read_state(robot, dofs)], []
    start_qd = to_numpy(robot.get_dofs_velocity(dofs))
    robot.control_dofs_position(q_target, dofs)
    start_control_force = to_numpy(robot.get_dofs_control_force(dofs))
    effort_limit = to_numpy(robot.get_dofs_force_range(dofs)[1])
    for _ in range(cases[0].steps):
        robot.control_dofs_position(q_target, dofs)
        scene.step()
        states.append(joint_control.read_state(robot, dofs))
        steps.append(joint_control.read_step(robot, dofs))
    return [
        joint_control.assemble(
            case,
            [tuple(values[k] for values in state) for state in states],
            [tuple(values[k] for values in step) for step in steps],
            [case.q_target] * case.steps,
            start_qd[k],
            start_control_force[k],
            effort_limit[k],
        )
        for k, case in enumerate(cases)
    ]


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
