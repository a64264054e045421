"""Failures of joint control, made on purpose: what a failure is, and those of a wrong command.

Every function makes one mistake and measures what follows. None is a way to do anything.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.mistakes import Failure, quoted, refused
from robo_genesis.core.quantities import format_value
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l04.metrics import SATURATION_THRESHOLD
from robo_genesis.sim.joint_control import CaseError, ControlCase, reset, validate
from robo_genesis.sim.joints import JointMap, to_numpy

SMALL = 0.05
"""Share of the commanded step that counts as nothing, beside the step itself."""


def positions(
    scene: Any, robot: Any, joints: JointMap, steps: int, before: Callable[[], None] | None = None
) -> FloatArray:
    """Step, calling `before` ahead of each; return position before the first and after each."""
    dofs = joints.dofs_idx_local.tolist()
    q = [to_numpy(robot.get_dofs_position(dofs))]
    for _ in range(steps):
        if before:
            before()
        scene.step()
        q.append(to_numpy(robot.get_dofs_position(dofs)))
    return np.stack(q)  # (steps + 1, d)


def wrong_index(scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str) -> Failure:
    """Command one joint by its solver-level index, where an entity-local one is asked for."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    wrong = list(robot.get_joint(joint).dofs_idx)  # the mistake: counted over the whole scene
    reset(scene, robot, joints, case)
    robot.control_dofs_position(case.q_start.copy(), dofs)  # all joints hold
    robot.control_dofs_position(case.q_target[[k]], wrong)
    q = positions(scene, robot, joints, case.steps)
    moved = np.abs(q[-1] - q[0])
    other = int(moved.argmax())
    t = np.arange(len(q)) * case.dt
    return Failure(
        "wrong_index",
        shown=bool(dofs[other] == wrong[0] and moved[other] > 10 * moved[k]),
        evidence=(
            f"`{joint}` has the entity-local DOF {dofs[k]} and the solver-level DOF {wrong[0]}. "
            f"Commanded with index {wrong[0]}, `{joints.names[other]}` moved most: at the last "
            f"sample it was {in_unit(moved[other], joints, other)} from its start. `{joint}` moved "
            f"{in_unit(moved[k], joints, k)}."
        ),
        curves={
            f"{joint}, meant": (t, q[:, k]),
            f"{joints.names[other]}, moved most": (t, q[:, other]),
        },
    )


def past_a_limit(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str, beyond: float
) -> Failure:
    """Command a target that lies `beyond` [rad or m] past the joint's upper limit."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    q_target = np.array(case.q_target)
    q_target[k] = joints.upper[k] + beyond
    refusal = refused(lambda: validate(replace(case, q_target=q_target), joints))
    reset(scene, robot, joints, case)
    robot.control_dofs_position(q_target, dofs)  # the mistake: not validated
    q = positions(scene, robot, joints, case.steps)[:, k]
    effort = float(to_numpy(robot.get_dofs_control_force(dofs))[k])
    short = abs(q_target[k] - q[-1])
    return Failure(
        "past_a_limit",
        shown=bool(
            isinstance(refusal, CaseError)
            and short > 0.5 * beyond
            and abs(effort) >= SATURATION_THRESHOLD * case.effort_limit[k]
            and abs(q[-1] - q[-2]) < SMALL * beyond
        ),
        evidence=(
            f"The engine took the target without a word. `{joint}` ended "
            f"{in_unit(short, joints, k)} from it, at {in_unit(q[-1], joints, k)} with its limit "
            f"at {in_unit(joints.upper[k], joints, k)}, and the controller still pushed with "
            f"{format_value(effort, joints.effort_units[k])}. "
            f"The course's own test before a run: {quoted(refusal)}"
        ),
        curves={"commanded past its limit": (np.arange(len(q)) * case.dt, q)},
    )


def lengths_differ(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str
) -> Failure:
    """Command all joints with too few values: one for each arm joint, then a single one."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    few = case.q_target[:7].copy()
    reset(scene, robot, joints, case)
    seven = refused(lambda: robot.control_dofs_position(few, dofs))
    one = refused(lambda: robot.control_dofs_position(case.q_target[[k]], dofs))
    q = positions(scene, robot, joints, case.steps)
    refusal = refused(lambda: validate(replace(case, q_target=case.q_target[[k]]), joints))
    moved = np.abs(q[-1] - q[0]) > 10 * SMALL * abs(case.q_target[k] - case.q_start[k])
    others = [
        name for name, gone in zip(joints.names, moved, strict=True) if gone and name != joint
    ]
    return Failure(
        "lengths_differ",
        shown=type(seven).__name__ == "GenesisException"
        and one is None
        and bool(others)
        and isinstance(refusal, CaseError),
        evidence=(
            f"- Seven values for nine joints: {quoted(seven)}\n"
            f"- One value for nine joints: {quoted(one)} It was meant for `{joint}`; also moved: "
            f"{', '.join(f'`{name}`' for name in others) or 'none'}.\n"
            f"- The course's own test before a run: {quoted(refusal)}"
        ),
    )


def fingers_without_gains(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, opening: float
) -> Failure:
    """Command an opening [m] of the fingers of a fresh robot, before gains are set and after."""
    dofs = joints.dofs_idx_local.tolist()
    q_target = np.array(case.q_start)
    q_target[-2:] = opening

    def run() -> FloatArray:
        scene.reset()
        robot.set_dofs_position(case.q_start.copy(), dofs, zero_velocity=True)
        robot.control_dofs_position(q_target, dofs)
        return positions(scene, robot, joints, case.steps)[:, -1]

    unset = run()
    robot.set_dofs_kp(case.kp.copy(), dofs)
    robot.set_dofs_kv(case.kv.copy(), dofs)
    own = run()
    t, last = np.arange(len(own)) * case.dt, len(joints.names) - 1
    return Failure(
        "fingers_without_gains",
        shown=bool(abs(unset[-1] - opening) > 0.5 * opening)
        and bool(abs(own[-1] - opening) < SMALL * opening),
        evidence=(
            f"Commanded to {in_unit(opening, joints, last)}, `{joints.names[last]}` ended at "
            f"{in_unit(unset[-1], joints, last)} before gains were set and at "
            f"{in_unit(own[-1], joints, last)} with gains of its own."
        ),
        curves={"before gains are set": (t, unset), "with gains set": (t, own)},
    )


def in_unit(value: Any, joints: JointMap, k: int) -> str:
    """Write a position of joint `k` for a reader."""
    return format_value(float(value), joints.position_units[k])
