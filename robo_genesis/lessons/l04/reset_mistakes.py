"""Failures of the reset, made on purpose: used for control, done by half, or left out."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from robo_genesis.core.mistakes import Failure
from robo_genesis.core.quantities import format_value
from robo_genesis.lessons.l04.mistakes import SMALL, in_unit, positions
from robo_genesis.sim.joint_control import ControlCase, reset, run_case
from robo_genesis.sim.joints import JointMap, to_numpy


def assigned_each_step(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str
) -> Failure:
    """Write the target into the state before each step, where a command was meant."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    reset(scene, robot, joints, case)

    def mistake() -> None:
        robot.set_dofs_position(case.q_target.copy(), dofs, zero_velocity=True)

    first = positions(scene, robot, joints, 1, mistake)[:, k]
    read = float(to_numpy(robot.get_dofs_velocity(dofs))[k])
    rest = positions(scene, robot, joints, case.steps - 1, mistake)[:, k]
    q = np.append(first, rest[1:])
    step, left = case.q_target[k] - case.q_start[k], abs(case.q_target[k] - q[1])
    needed = (q[1] - q[0]) / case.dt
    unit = joints.position_units[k]
    return Failure(
        "assigned_each_step",
        shown=bool(left < SMALL * abs(step) and abs(read) < SMALL * abs(needed)),
        evidence=(
            f"At the first sample after the start, {case.dt:g} s later, `{joint}` is "
            f"{in_unit(left, joints, k)} from its target. To come there in that time it would have "
            f"needed {format_value(needed, f'{unit}/s')}; `get_dofs_velocity` reads "
            f"{format_value(read, f'{unit}/s')}."
        ),
        curves={"assigned before each step": (np.arange(len(q)) * case.dt, q)},
    )


def stale_target(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str
) -> Failure:
    """After a run, put only the position back, then step without a command."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    run_case(scene, robot, joints, case)
    robot.set_dofs_position(case.q_start.copy(), dofs, zero_velocity=True)  # no scene.reset()
    stale = positions(scene, robot, joints, case.steps)[:, k]
    reset(scene, robot, joints, case)
    robot.control_dofs_position(case.q_start.copy(), dofs)  # a first command before the first step
    held = positions(scene, robot, joints, case.steps)[:, k]
    t, step = np.arange(len(stale)) * case.dt, abs(case.q_target[k] - case.q_start[k])
    drift, kept = abs(stale[-1] - stale[0]), abs(held[-1] - held[0])
    return Failure(
        "stale_target",
        shown=bool(drift > 0.5 * step and kept < SMALL * step),
        evidence=(
            f"Nothing was commanded after the position was put back, and `{joint}` moved "
            f"{in_unit(abs(stale[1] - stale[0]), joints, k)} in the first step and "
            f"{in_unit(drift, joints, k)} in {case.steps}. After a complete reset and a "
            f"first command to stay, it moved {in_unit(kept, joints, k)} in as many."
        ),
        curves={"position put back, no command": (t, stale), "complete reset": (t, held)},
    )


def gains_without_reset(
    scene: Any,
    robot: Any,
    joints: JointMap,
    cases: Sequence[ControlCase],
    joint: str,
) -> Failure:
    """Run the second case where the first one ended: new gains, but no reset."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    first, second = cases
    fair = run_case(scene, robot, joints, second)
    run_case(scene, robot, joints, first)
    robot.set_dofs_kp(second.kp.copy(), dofs)  # the mistake: nothing else is put back
    robot.set_dofs_kv(second.kv.copy(), dofs)
    robot.control_dofs_position(second.q_target.copy(), dofs)
    q = positions(scene, robot, joints, second.steps)[:, k]
    asked = abs(second.q_target[k] - second.q_start[k])
    found = abs(second.q_target[k] - q[0])
    t = np.arange(len(q)) * second.dt
    return Failure(
        "gains_without_reset",
        shown=bool(found < SMALL * asked and np.ptp(q) < SMALL * np.ptp(fair.q[:, k])),
        evidence=(
            f"The second run began {in_unit(found, joints, k)} from its target instead of "
            f"{in_unit(asked, joints, k)}. In the whole window `{joint}` moved through "
            f"{in_unit(np.ptp(q), joints, k)}; after a reset it moves through "
            f"{in_unit(np.ptp(fair.q[:, k]), joints, k)}."
        ),
        curves={"no reset": (t, q), "after a reset": (fair.t, fair.q[:, k])},
    )
