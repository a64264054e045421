"""Mistakes in joint control, made on purpose: commands, resets and readings.

Every function makes one mistake and measures its effect. Do not copy them.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.core.scene import DT, FloatArray
from robo_genesis.core.text import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import is_saturated, step_metrics
from robo_genesis.lessons.l04.spec import ENTRY, STEPPED_JOINT
from robo_genesis.sim.arm.joint_control import ControlCase, reset, run_case, validate
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.session import CaseError

MEASURES = False

SMALL = 0.05  # Share of the commanded step that counts as negligible


@dataclass(frozen=True, slots=True)
class Arm:
    """A robot in a built scene, with its joints."""

    scene: Any
    robot: Any
    joints: JointMap

    @property
    def dofs(self) -> list[int]:
        """The local DOF indices of all joints."""
        return [int(dof) for dof in self.joints.dofs_idx_local]

    def reset(self, case: ControlCase) -> None:
        """Put the robot completely into the start of a case."""
        reset(self.scene, self.robot, self.joints, case)

    def run(self, case: ControlCase) -> Trace:
        """Run a case as the course does."""
        return run_case(self.scene, self.robot, self.joints, case)

    def position(self, q: Any, entry: int = ENTRY) -> str:
        """Write a position of a joint with its unit."""
        return format_value(float(q), self.joints.position_units[entry])

    def positions(self, steps: int, before: Callable[[], None] = lambda: None) -> FloatArray:
        """Step, calling `before` ahead of each; return position (steps+1, d) at the start and then.

        The unit is rad or m.
        """
        q = [to_numpy(self.robot.get_dofs_position(self.dofs))]
        for _ in range(steps):
            before()
            self.scene.step()
            q.append(to_numpy(self.robot.get_dofs_position(self.dofs)))
        return np.stack(q)


def failure(
    name: str, shown: Any, evidence: str, curves: Mapping[str, FloatArray] | None = None
) -> Mistake:
    """Return the result of a mistake; the curves are positions at each sample, by label."""
    drawn = {label: (np.arange(len(q)) * DT, q) for label, q in (curves or {}).items()}
    return Mistake(name, bool(shown), evidence, drawn, "position [rad]")


def wrong_index(arm: Arm, case: ControlCase) -> Mistake:
    """Command one joint by its solver-level index, where an entity-local one is required."""
    wrong = list(arm.robot.get_joint(STEPPED_JOINT).dofs_idx)  # the mistake: of the whole scene
    arm.reset(case)
    arm.robot.control_dofs_position(case.q_start.copy(), arm.dofs)  # all joints hold
    arm.robot.control_dofs_position(case.q_target[[ENTRY]], wrong)
    q = arm.positions(case.steps)
    moved = np.abs(q[-1] - q[0])
    other = int(moved.argmax())
    name = arm.joints.names[other]
    return failure(
        "wrong_index",
        arm.dofs[other] == wrong[0] and moved[other] > 10 * moved[ENTRY],
        f"`{STEPPED_JOINT}` has the entity-local DOF {arm.dofs[ENTRY]} and the solver-level DOF "
        f"{wrong[0]}. Commanded with index {wrong[0]}, `{name}` moved most: at the last sample it "
        f"was {arm.position(moved[other], other)} from its start. `{STEPPED_JOINT}` moved "
        f"{arm.position(moved[ENTRY])}.",
        {f"{STEPPED_JOINT}, meant": q[:, ENTRY], f"{name}, moved most": q[:, other]},
    )


def past_a_limit(arm: Arm, case: ControlCase, beyond: float) -> Mistake:
    """Command a target that lies `beyond` [rad] past the joint's upper limit."""
    q_target, limit = np.array(case.q_target), arm.joints.upper[ENTRY]
    q_target[ENTRY] = limit + beyond
    refusal = refused(lambda: validate(replace(case, q_target=q_target), arm.joints))
    arm.reset(case)
    arm.robot.control_dofs_position(q_target, arm.dofs)  # the mistake: not validated
    q = arm.positions(case.steps)[:, ENTRY]
    effort = float(to_numpy(arm.robot.get_dofs_control_force(arm.dofs))[ENTRY])
    short, pushes = abs(q_target[ENTRY] - q[-1]), is_saturated(effort, case.effort_limit[ENTRY])
    stopped = short > 0.5 * beyond and abs(q[-1] - q[-2]) < SMALL * beyond
    return failure(
        "past_a_limit",
        isinstance(refusal, CaseError) and stopped and pushes,
        f"The engine accepted the target without a warning. `{STEPPED_JOINT}` ended "
        f"{arm.position(short)} from it, at {arm.position(q[-1])} with its limit at "
        f"{arm.position(limit)}. The control force was still {format_value(effort, 'N·m')}. "
        f"The course's validation before a run: {quoted(refusal)}",
        {"commanded past its limit": q},
    )


def lengths_differ(arm: Arm, case: ControlCase) -> Mistake:
    """Command all joints with too few values: one for each arm joint, then a single one."""
    one_value = case.q_target[[ENTRY]]
    arm.reset(case)
    seven = refused(lambda: arm.robot.control_dofs_position(case.q_target[:7].copy(), arm.dofs))
    one = refused(lambda: arm.robot.control_dofs_position(one_value, arm.dofs))
    q = arm.positions(case.steps)
    refusal = refused(lambda: validate(replace(case, q_target=one_value), arm.joints))
    step = abs(case.q_target[ENTRY] - case.q_start[ENTRY])
    moved = np.flatnonzero(np.abs(q[-1] - q[0]) > 10 * SMALL * step)
    others = [f"`{arm.joints.names[n]}`" for n in moved if n != ENTRY]
    named = type(seven).__name__ == "GenesisException" and isinstance(refusal, CaseError)
    return failure(
        "lengths_differ",
        named and one is None and others,
        f"- Seven values for nine joints: {quoted(seven)}\n"
        f"- One value for nine joints: {quoted(one)} The value was meant for `{STEPPED_JOINT}`. "
        f"Other arm joints that moved: {', '.join(others) or 'none'}.\n"
        f"- The course's validation before a run: {quoted(refusal)}",
    )


def fingers_without_gains(arm: Arm, case: ControlCase, opening: float) -> Mistake:
    """Command an opening [m] of the fingers of a fresh robot, before gains are set and after."""
    q_target, finger = np.array(case.q_start), len(arm.dofs) - 1
    q_target[-2:] = opening

    def run() -> FloatArray:
        arm.scene.reset()
        arm.robot.set_dofs_position(case.q_start.copy(), arm.dofs, zero_velocity=True)
        arm.robot.control_dofs_position(q_target, arm.dofs)
        return arm.positions(case.steps)[:, finger]

    unset = run()
    arm.robot.set_dofs_kp(case.kp.copy(), arm.dofs)
    arm.robot.set_dofs_kv(case.kv.copy(), arm.dofs)
    own = run()
    off_unset, off_own = (abs(q[-1] - opening) for q in (unset, own))
    found = failure(
        "fingers_without_gains",
        off_unset > 0.5 * opening and off_own < SMALL * opening,
        f"Commanded to {arm.position(opening, finger)}, `{arm.joints.names[finger]}` ended at "
        f"{arm.position(unset[-1], finger)} before gains were set and at "
        f"{arm.position(own[-1], finger)} with gains of its own.",
        {"before gains are set": unset, "with gains set": own},
    )
    return replace(found, quantity="position [m]")


def assigned_each_step(arm: Arm, case: ControlCase) -> Mistake:
    """Write the target into the state before each step, where a command was meant."""
    arm.reset(case)

    def mistake() -> None:
        arm.robot.set_dofs_position(case.q_target.copy(), arm.dofs, zero_velocity=True)

    first = arm.positions(1, mistake)[:, ENTRY]
    read = float(to_numpy(arm.robot.get_dofs_velocity(arm.dofs))[ENTRY])
    q = np.append(first, arm.positions(case.steps - 1, mistake)[1:, ENTRY])
    step, left = case.q_target[ENTRY] - case.q_start[ENTRY], abs(case.q_target[ENTRY] - q[1])
    needed = (q[1] - q[0]) / case.dt
    return failure(
        "assigned_each_step",
        left < SMALL * abs(step) and abs(read) < SMALL * abs(needed),
        f"At the first sample after the start, {case.dt:g} s later, `{STEPPED_JOINT}` is "
        f"{arm.position(left)} from its target. This motion would have needed "
        f"{format_value(needed, 'rad/s')}; `get_dofs_velocity` reads "
        f"{format_value(read, 'rad/s')}.",
        {"assigned before each step": q},
    )


def stale_target(arm: Arm, case: ControlCase) -> Mistake:
    """After a run, restore only the position, then step without a command."""
    arm.run(case)
    arm.robot.set_dofs_position(case.q_start.copy(), arm.dofs, zero_velocity=True)  # the mistake
    stale = arm.positions(case.steps)[:, ENTRY]
    arm.reset(case)
    arm.robot.control_dofs_position(case.q_start.copy(), arm.dofs)  # before the first step
    fresh = arm.positions(case.steps)[:, ENTRY]
    step = abs(case.q_target[ENTRY] - case.q_start[ENTRY])
    drift, kept = (abs(q[-1] - q[0]) for q in (stale, fresh))
    return failure(
        "stale_target",
        drift > 0.5 * step and kept < SMALL * step,
        f"No command followed after the position was restored, yet `{STEPPED_JOINT}` moved "
        f"{arm.position(abs(stale[1] - stale[0]))} in the first step and {arm.position(drift)} in "
        f"{case.steps} steps. After a complete reset and a first command to stay, it moved "
        f"{arm.position(kept)} in as many steps.",
        {"position restored, no command": stale, "complete reset": fresh},
    )


def gains_without_reset(arm: Arm, cases: Sequence[ControlCase]) -> Mistake:
    """Run the second case where the first one ended: new gains, but no reset."""
    first, second = cases
    fair = arm.run(second).q[:, ENTRY]
    arm.run(first)
    arm.robot.set_dofs_kp(second.kp.copy(), arm.dofs)  # the mistake: nothing else is reset
    arm.robot.set_dofs_kv(second.kv.copy(), arm.dofs)
    arm.robot.control_dofs_position(second.q_target.copy(), arm.dofs)
    q = arm.positions(second.steps)[:, ENTRY]
    step, found = (abs(second.q_target[ENTRY] - start) for start in (second.q_start[ENTRY], q[0]))
    return failure(
        "gains_without_reset",
        found < SMALL * step and np.ptp(q) < SMALL * np.ptp(fair),
        f"The second run began {arm.position(found)} from its target instead of "
        f"{arm.position(step)}. In the whole window `{STEPPED_JOINT}` moved through "
        f"{arm.position(np.ptp(q))}; after a reset it moves through {arm.position(np.ptp(fair))}.",
        {"no reset": q, "after a reset": fair},
    )


def wrong_getter(trace: Trace) -> Mistake:
    """Read the net force at the end of a run as the motor's effort."""
    net, control = (float(f[-1, ENTRY]) for f in (trace.internal_force, trace.control_force))
    return failure(
        "wrong_getter",
        abs(net) < SMALL * abs(control),
        f"At the last sample `get_dofs_force` is {format_value(net, 'N·m')} and "
        f"`get_dofs_control_force` is {format_value(control, 'N·m')}.",
    )


def time_shift(trace: Trace) -> Mistake:
    """Label the first state after a step as t = 0, and measure again."""
    names = ("q", "link_pos", "link_quat", "qd", "target", "control_force", "internal_force")
    late = {name: getattr(trace, name)[1:] for name in names}
    right = step_metrics(trace, ENTRY)
    shifted = step_metrics(replace(trace, t=trace.t[:-1], **late), ENTRY)  # the mistake
    texts, gaps = [], []
    for name in ("rise_time", "settling_time"):
        early, time = (getattr(of, name) for of in (shifted, right))
        values = [format_value(value, "s") for value in (early, time)]
        texts.append(f"{name.replace('_', ' ')} {' instead of '.join(values)}")
        gaps += [time - early] if None not in (early, time) else []
    return failure(
        "time_shift",
        gaps and np.allclose(gaps, trace.dt, rtol=0, atol=1e-9),
        f"From the same curve, the shifted times give {' and '.join(texts)}.",
    )
