"""Mistakes in joint control, made on purpose: commands, resets and readings.

Every function makes one mistake and measures its effect. Do not copy them.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import is_saturated, step_metrics
from robo_genesis.sim.arm.joint_control import CaseError, ControlCase, reset, run_case, validate
from robo_genesis.sim.arm.joints import JointMap, to_numpy

MEASURES = False

SMALL = 0.05
"""Share of the commanded step that counts as negligible."""


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


def wrong_index(scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str) -> Mistake:
    """Command one joint by its solver-level index, where an entity-local one is required."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    wrong = list(robot.get_joint(joint).dofs_idx)  # the mistake: counted over the whole scene
    reset(scene, robot, joints, case)
    robot.control_dofs_position(case.q_start.copy(), dofs)  # all joints hold
    robot.control_dofs_position(case.q_target[[k]], wrong)
    q = positions(scene, robot, joints, case.steps)
    moved = np.abs(q[-1] - q[0])
    other = int(moved.argmax())
    t = np.arange(len(q)) * case.dt
    return Mistake(
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
        quantity=f"position [{joints.position_units[k]}]",
    )


def past_a_limit(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str, beyond: float
) -> Mistake:
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
    return Mistake(
        "past_a_limit",
        shown=bool(
            isinstance(refusal, CaseError)
            and short > 0.5 * beyond
            and is_saturated(effort, case.effort_limit[k])
            and abs(q[-1] - q[-2]) < SMALL * beyond
        ),
        evidence=(
            f"The engine accepted the target without a warning. `{joint}` ended "
            f"{in_unit(short, joints, k)} from it, at {in_unit(q[-1], joints, k)} with its limit "
            f"at {in_unit(joints.upper[k], joints, k)}. The control force was still "
            f"{format_value(effort, joints.effort_units[k])}. "
            f"The course's validation before a run: {quoted(refusal)}"
        ),
        curves={"commanded past its limit": (np.arange(len(q)) * case.dt, q)},
        quantity=f"position [{joints.position_units[k]}]",
    )


def lengths_differ(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str
) -> Mistake:
    """Command all joints with too few values: one for each arm joint, then a single one."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    few = case.q_target[:7].copy()
    reset(scene, robot, joints, case)
    seven = refused(lambda: robot.control_dofs_position(few, dofs))
    one = refused(lambda: robot.control_dofs_position(case.q_target[[k]], dofs))
    q = positions(scene, robot, joints, case.steps)
    refusal = refused(lambda: validate(replace(case, q_target=case.q_target[[k]]), joints))
    moved = np.abs(q[-1] - q[0]) > 10 * SMALL * abs(case.q_target[k] - case.q_start[k])
    others = [joints.names[n] for n in np.flatnonzero(moved) if n != k]
    return Mistake(
        "lengths_differ",
        shown=type(seven).__name__ == "GenesisException"
        and one is None
        and bool(others)
        and isinstance(refusal, CaseError),
        evidence=(
            f"- Seven values for nine joints: {quoted(seven)}\n"
            f"- One value for nine joints: {quoted(one)} The value was meant for `{joint}`. "
            f"Other arm joints that moved: {', '.join(f'`{name}`' for name in others) or 'none'}.\n"
            f"- The course's validation before a run: {quoted(refusal)}"
        ),
    )


def fingers_without_gains(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, opening: float
) -> Mistake:
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
    return Mistake(
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


def assigned_each_step(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str
) -> Mistake:
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
    needed, unit = (q[1] - q[0]) / case.dt, f"{joints.position_units[k]}/s"
    return Mistake(
        "assigned_each_step",
        shown=bool(left < SMALL * abs(step) and abs(read) < SMALL * abs(needed)),
        evidence=(
            f"At the first sample after the start, {case.dt:g} s later, `{joint}` is "
            f"{in_unit(left, joints, k)} from its target. This motion would have needed "
            f"{format_value(needed, unit)}; `get_dofs_velocity` reads {format_value(read, unit)}."
        ),
        curves={"assigned before each step": (np.arange(len(q)) * case.dt, q)},
        quantity=f"position [{joints.position_units[k]}]",
    )


def stale_target(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, joint: str
) -> Mistake:
    """After a run, restore only the position, then step without a command."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    run_case(scene, robot, joints, case)
    robot.set_dofs_position(case.q_start.copy(), dofs, zero_velocity=True)  # no scene.reset()
    stale = positions(scene, robot, joints, case.steps)[:, k]
    reset(scene, robot, joints, case)
    robot.control_dofs_position(case.q_start.copy(), dofs)  # a first command before the first step
    fresh = positions(scene, robot, joints, case.steps)[:, k]
    t, step = np.arange(len(stale)) * case.dt, abs(case.q_target[k] - case.q_start[k])
    drift, kept = abs(stale[-1] - stale[0]), abs(fresh[-1] - fresh[0])
    return Mistake(
        "stale_target",
        shown=bool(drift > 0.5 * step and kept < SMALL * step),
        evidence=(
            f"No command followed after the position was restored, yet `{joint}` moved "
            f"{in_unit(abs(stale[1] - stale[0]), joints, k)} in the first step and "
            f"{in_unit(drift, joints, k)} in {case.steps} steps. After a complete reset and a "
            f"first command to stay, it moved {in_unit(kept, joints, k)} in as many steps."
        ),
        curves={"position restored, no command": (t, stale), "complete reset": (t, fresh)},
        quantity=f"position [{joints.position_units[k]}]",
    )


def gains_without_reset(
    scene: Any, robot: Any, joints: JointMap, cases: Sequence[ControlCase], joint: str
) -> Mistake:
    """Run the second case where the first one ended: new gains, but no reset."""
    k, dofs = joints.entry(joint), joints.dofs_idx_local.tolist()
    first, second = cases
    fair = run_case(scene, robot, joints, second)
    run_case(scene, robot, joints, first)
    robot.set_dofs_kp(second.kp.copy(), dofs)  # the mistake: nothing else is reset
    robot.set_dofs_kv(second.kv.copy(), dofs)
    robot.control_dofs_position(second.q_target.copy(), dofs)
    q = positions(scene, robot, joints, second.steps)[:, k]
    step, found = (abs(second.q_target[k] - start) for start in (second.q_start[k], q[0]))
    return Mistake(
        "gains_without_reset",
        shown=bool(found < SMALL * step and np.ptp(q) < SMALL * np.ptp(fair.q[:, k])),
        evidence=(
            f"The second run began {in_unit(found, joints, k)} from its target instead of "
            f"{in_unit(step, joints, k)}. In the whole window `{joint}` moved through "
            f"{in_unit(np.ptp(q), joints, k)}; after a reset it moves through "
            f"{in_unit(np.ptp(fair.q[:, k]), joints, k)}."
        ),
        curves={
            "no reset": (np.arange(len(q)) * second.dt, q),
            "after a reset": (fair.t, fair.q[:, k]),
        },
        quantity=f"position [{joints.position_units[k]}]",
    )


def wrong_getter(trace: Trace, joints: JointMap, joint: str) -> Mistake:
    """Read the net force at the end of a run as the motor's effort."""
    k = joints.entry(joint)
    net, control = float(trace.internal_force[-1, k]), float(trace.control_force[-1, k])
    unit = joints.effort_units[k]
    return Mistake(
        "wrong_getter",
        shown=abs(net) < SMALL * abs(control),
        evidence=(
            f"At the last sample `get_dofs_force` is {format_value(net, unit)} and "
            f"`get_dofs_control_force` is {format_value(control, unit)}."
        ),
    )


def time_shift(trace: Trace, joints: JointMap, joint: str) -> Mistake:
    """Label the first state after a step as t = 0, and measure again."""
    k = joints.entry(joint)
    names = ("q", "link_pos", "link_quat", "qd", "target", "control_force", "internal_force")
    late = {name: getattr(trace, name)[1:] for name in names}
    right = step_metrics(trace, k)
    shifted = step_metrics(replace(trace, t=trace.t[:-1], **late), k)  # the mistake
    pairs = {
        "rise time": (shifted.rise_time, right.rise_time),
        "settling time": (shifted.settling_time, right.settling_time),
    }
    texts = [
        f"{name} {format_value(early, 's')} instead of {format_value(time, 's')}"
        for name, (early, time) in pairs.items()
    ]
    gaps = [b - a for a, b in pairs.values() if a is not None and b is not None]
    return Mistake(
        "time_shift",
        shown=bool(gaps) and np.allclose(gaps, trace.dt, rtol=0, atol=1e-9),
        evidence=f"From the same curve, the shifted times give {' and '.join(texts)}.",
    )


def in_unit(value: Any, joints: JointMap, k: int) -> str:
    """Write a position of joint `k` with its unit."""
    return format_value(float(value), joints.position_units[k])
