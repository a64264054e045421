"""Many control cases at once, one in each environment of a batched scene, and what they did."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec
from robo_genesis.lessons.l04.grid_spec import GridPoint
from robo_genesis.lessons.l04.metrics import StepMetrics, step_metrics
from robo_genesis.sim.joint_control import (
    CaseError,
    ControlCase,
    assemble,
    read_state,
    read_step,
    require_read_back,
    validate,
)
from robo_genesis.sim.joints import JointMap, to_numpy


@dataclass(frozen=True, slots=True)
class Sweep:
    """What the stepped joint did at each of p points, in runs of n steps.

    | field | shape | meaning |
    |---|---|---|
    | `points` | (p,) | gains and step of each run |
    | `cases` | (p,) | the whole case that was run there |
    | `t` | (n+1,) | time of each state [s] |
    | `q` | (p, n+1) | position [rad] |
    | `control_force` | (p, n) | control force after each step, stamped t[1] … t[n] [N·m] |
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
            ValueError: it is none of the grid's.
        """
        return self.points.index(point)


def sweep(scene: Any, robot: Any, joints: JointMap, points: Sequence[GridPoint]) -> Sweep:
    """Run every point, each in an environment of its own, and keep the stepped joint."""
    cases = tuple(point.case for point in points)
    return collect(points, cases, run_batch(scene, robot, joints, cases), joints)


def collect(
    points: Sequence[GridPoint],
    cases: Sequence[ControlCase],
    traces: Sequence[Trace],
    joints: JointMap,
) -> Sweep:
    """Return the stepped joint's part of the points' traces, with its metrics."""
    k = joints.entry(spec.STEPPED_JOINT)
    found = Sweep(
        points=tuple(points),
        cases=tuple(cases),
        t=traces[0].t,
        q=np.stack([trace.q[:, k] for trace in traces]),
        control_force=np.stack([trace.control_force[:, k] for trace in traces]),
        effort_limit=np.stack([trace.effort_limit[k] for trace in traces]),
        metrics=tuple(step_metrics(trace, k) for trace in traces),
    )
    for array in (found.q, found.control_force, found.effort_limit):
        array.setflags(write=False)
    return found


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
    reset_batch(scene, robot, joints, cases)
    dofs = joints.dofs_idx_local.tolist()
    states, steps = [read_state(robot, dofs)], []
    start_qd = to_numpy(robot.get_dofs_velocity(dofs))
    q_target = stacked(cases, "q_target")
    robot.control_dofs_position(q_target, dofs)
    start_control_force = to_numpy(robot.get_dofs_control_force(dofs))
    effort_limit = to_numpy(robot.get_dofs_force_range(dofs)[1])
    for _ in range(cases[0].steps):
        robot.control_dofs_position(q_target, dofs)
        scene.step()
        states.append(read_state(robot, dofs))
        steps.append(read_step(robot, dofs))
    return [
        assemble(
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


def reset_batch(scene: Any, robot: Any, joints: JointMap, cases: Sequence[ControlCase]) -> None:
    """Do as `joint_control.reset` does in every environment, and read back what was set.

    Raises:
        CaseError: the scene does not fit the cases, a case must not be run, or the engine reads
            back something else than was asked for.
    """
    for case in cases:
        validate(case, joints)
    found = (scene.n_envs, scene.dt, scene.substeps)
    asked = {(len(cases), case.dt, case.substeps) for case in cases}
    if asked != {found} or len({case.steps for case in cases}) != 1:
        raise CaseError(
            f"The scene has (environments, dt, substeps) {found}, the cases ask for "
            f"{sorted(asked)}. Build it with n_envs={len(cases)}, for cases of equal length."
        )
    dofs = joints.dofs_idx_local.tolist()
    batch = replace(
        cases[0],
        q_start=stacked(cases, "q_start"),
        kp=stacked(cases, "kp"),
        kv=stacked(cases, "kv"),
        effort_limit=stacked(cases, "effort_limit"),
    )
    scene.reset()
    robot.set_dofs_kp(batch.kp, dofs)
    robot.set_dofs_kv(batch.kv, dofs)
    robot.set_dofs_force_range(-batch.effort_limit, batch.effort_limit, dofs)
    robot.set_dofs_position(batch.q_start, dofs, zero_velocity=True)
    require_read_back(robot, dofs, batch)


def stacked(cases: Sequence[ControlCase], field: str) -> FloatArray:
    """Return one array of the cases as (cases, joints)."""
    return np.stack([getattr(case, field) for case in cases])
