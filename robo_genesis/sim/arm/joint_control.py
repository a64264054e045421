"""Position control of a robot's joints: reset, command a target, step, record."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robo_genesis.core.check_spec import LIMIT_TOLERANCE
from robo_genesis.core.scene import SEED, FloatArray, Stepped
from robo_genesis.core.trace import Trace
from robo_genesis.sim.session import CaseError, require_built

from . import franka
from .joints import JointMap, to_numpy
from .model import RobotModel


@dataclass(frozen=True, slots=True, kw_only=True)
class Controlled(Stepped):
    """A robot under position control. A lesson's case adds what it commands.

    Arrays have one entry for each joint, in the order of the map, and are by default
    those of the Franka, as is the `model`: `q_start` [rad or m]; `kp` [N·m/rad or N/m];
    `kv` [N·m·s/rad or N·s/m]; `effort_limit` [N·m or N], symmetric. `steps`
    counts outer steps.
    """

    model: RobotModel = franka.FRANKA
    q_start: FloatArray = field(default_factory=lambda: franka.Q_START)
    kp: FloatArray = field(default_factory=lambda: franka.KP_BASELINE)
    kv: FloatArray = field(default_factory=lambda: franka.KV_BASELINE)
    effort_limit: FloatArray = field(default_factory=lambda: franka.EFFORT_LIMIT)
    steps: int
    seed: int = SEED

    def commanding(self, q_target: FloatArray) -> "ControlCase":
        """Return the control case that commands joint positions (d,) or (n, d) [rad or m]."""
        settings = {of.name: getattr(self, of.name) for of in fields(Controlled)}
        return ControlCase(q_target=q_target, **settings)


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlCase(Controlled):
    """All settings of one run: those of the robot, and the `q_target` [rad or m].

    The target is one for all steps, (d,), or one for each, (n, d).
    """

    q_target: FloatArray


def differences(one: ControlCase, other: ControlCase, joints: JointMap) -> list[str]:
    """Name every field, and joint within it, in which two cases differ: `["kp[joint4]"]`."""
    found: list[str] = []
    for name in (one.name for one in fields(ControlCase)):
        a, b = getattr(one, name), getattr(other, name)
        if np.ndim(a) == 0:
            found += [name] * bool(a != b)
        else:
            found += [f"{name}[{joints.names[k]}]" for k in np.flatnonzero(a != b)]
    return found


def validate(case: ControlCase, joints: JointMap) -> None:
    """Refuse a case that is not valid as written; nothing is clipped or broadcast.

    Raises:
        CaseError: naming the field, the joint, the value and what is valid.
    """
    n = len(joints.names)
    for name in ("q_start", "q_target", "kp", "kv", "effort_limit"):
        values, is_state = np.asarray(getattr(case, name)), name.startswith("q_")
        if values.shape not in [(n,), *[(case.steps, n)] * (name == "q_target")]:
            raise CaseError(
                f"{name} has shape {values.shape}, expected ({n},): one value for each of "
                f"{', '.join(joints.names)}. Slice values and indices together."
            )
        limits = np.zeros(n), np.full(n, np.inf)
        lower, upper = (joints.lower, joints.upper) if is_state else limits
        beyond = np.maximum(lower - values, values - upper)
        valid = np.isfinite(values) & (beyond <= LIMIT_TOLERANCE * is_state)
        for *row, k in np.argwhere(~valid).tolist():
            unit = f" {joints.position_units[k]}" * is_state
            raise CaseError(
                f"{name}[{joints.names[k]}] is {values[*row, k]:g}{unit}, outside its range "
                f"[{lower[k]:g}, {upper[k]:g}]. Choose a value inside; none is clipped."
            )


def reset(scene: Any, robot: Any, joints: JointMap, case: ControlCase) -> None:
    """Bring scene and controller to the case's start, whatever ran before.

    `scene.reset()` clears state and control mode but keeps gains and effort range, so
    these are set again and read back; then the start position is assigned with zero
    velocity.

    Raises:
        CaseError: the scene is not built yet or has another time step, or what the
            engine reads back differs from what was asked for.
    """
    require_built(scene, case)
    validate(case, joints)
    scene.reset()
    set_up(robot, joints.dofs, case)


def set_up(robot: Any, dofs: list[int], case: ControlCase) -> None:
    """Set gains, effort range and start of a case, at rest, and read them back.

    The case's arrays are (d,), in a batch also (environments, d).

    Raises:
        CaseError: a value reads back differently from what was asked for.
    """
    robot.set_dofs_kp(case.kp.copy(), dofs)  # copies: Torch takes no read-only array
    robot.set_dofs_kv(case.kv.copy(), dofs)
    robot.set_dofs_force_range(-case.effort_limit, case.effort_limit.copy(), dofs)
    robot.set_dofs_position(case.q_start.copy(), dofs, zero_velocity=True)
    lower, upper = robot.get_dofs_force_range(dofs)
    read_back = {
        "kp": (robot.get_dofs_kp(dofs), case.kp),
        "kv": (robot.get_dofs_kv(dofs), case.kv),
        "effort_limit": (upper, case.effort_limit),
        "-effort_limit": (lower, -case.effort_limit),
        "q_start": (robot.get_dofs_position(dofs), case.q_start),
        "velocity": (robot.get_dofs_velocity(dofs), np.zeros_like(case.q_start)),
    }
    for name, (found, asked) in read_back.items():
        if not np.allclose(to_numpy(found), asked, rtol=1e-6, atol=LIMIT_TOLERANCE):
            raise CaseError(
                f"{name} reads back {to_numpy(found)} after reset, asked for {asked}."
            )


def run_case(
    scene: Any,
    robot: Any,
    joints: JointMap,
    case: ControlCase,
    bodies: Sequence[Any] = (),
    begin: Callable[[], None] | None = None,
    after: Callable[[int], None] | None = None,
) -> Trace:
    """Reset, then command the target of each step and step; record every state.

    Position, link poses: before the first step and after each. Velocity and both
        forces: after
    each step, with the time at which the step ends. `get_dofs_control_force` computes
    its value from the state at the call, so after a step it belongs to the new state.

    Args:
        scene: built, with the robot.
        robot: its entity.
        joints: all its joints.
        case: the settings.
        bodies: further entities whose links the trace has after those of the robot.
        begin: is called after the reset, as to place a body.
        after: is called after each step with its number, as to read contacts.

    Returns:
        A trace of `case.steps` steps.
    """
    reset(scene, robot, joints, case)
    if begin:
        begin()
    dofs = joints.dofs
    targets = np.broadcast_to(case.q_target, (case.steps, len(dofs))).copy()
    robot.control_dofs_position(targets[0], dofs)
    readings = [read(robot, dofs, bodies)]
    effort_limit = to_numpy(robot.get_dofs_force_range(dofs)[1])
    for k, q_target in enumerate(targets):
        robot.control_dofs_position(q_target, dofs)  # at t[k]: the target of this step
        scene.step()  # bounded effort drives the dynamics for dt
        readings.append(read(robot, dofs, bodies))  # at t[k+1]: the new state
        if after:
            after(k)
    return assemble(case, readings, targets, effort_limit)


def assign_path(scene: Any, robot: Any, joints: JointMap, case: ControlCase) -> Trace:
    """Assign the states of a straight line from start to target, without control and steps.

    This sequence of resets is the contrast to `run_case`; see `assign_postures`.
    """
    path = np.linspace(case.q_start, case.q_target, case.steps + 1)[1:]
    return assign_postures(scene, robot, joints, case, path)


def assign_postures(
    scene: Any, robot: Any, joints: JointMap, case: ControlCase, postures: FloatArray
) -> Trace:
    """Reset, then assign postures (case.steps, d) [rad or m] one after the other, and read each.

    Returns:
        A trace of the start and the assigned postures. Its time is nominal: none
        passed.
    """
    reset(scene, robot, joints, case)
    dofs = joints.dofs
    effort_limit = to_numpy(robot.get_dofs_force_range(dofs)[1])
    readings = [read(robot, dofs)]
    for q in postures:
        robot.set_dofs_position(q, dofs, zero_velocity=True)
        readings.append(read(robot, dofs))
    return assemble(case, readings, postures, effort_limit)


def assemble(
    case: ControlCase,
    readings: Sequence[tuple[FloatArray, ...]],
    targets: ArrayLike,
    effort_limit: FloatArray,
) -> Trace:
    """Return the run of a case as a trace.

    Args:
        case: its settings.
        readings: of the n+1 states, as of `read`; the first after the first command.
        targets: (n, d) commands [rad or m].
        effort_limit: (d,) as read back [N·m or N].
    """
    q, link_pos, link_quat, qd, control_force, internal_force = map(
        np.stack, zip(*readings, strict=True)
    )
    return Trace(
        t=np.arange(case.steps + 1) * case.dt,
        q=q,
        qd=qd[1:],
        target=np.asarray(targets),
        control_force=control_force[1:],
        internal_force=internal_force[1:],
        start_control_force=control_force[0],
        start_qd=qd[0],
        effort_limit=effort_limit,
        link_pos=link_pos,
        link_quat=link_quat,
    )


def read(
    robot: Any, dofs: list[int], bodies: Sequence[Any] = ()
) -> tuple[FloatArray, ...]:
    """Return what the engine has now, in a batch with an axis of environments first.

    Position (d,), link positions (l, 3) [m] and orientations (l, 4), those of `bodies`
    last; velocity, control force and internal force, each (d,).
    """
    pos = [to_numpy(entity.get_links_pos()) for entity in (robot, *bodies)]
    quat = [to_numpy(entity.get_links_quat()) for entity in (robot, *bodies)]
    return (
        to_numpy(robot.get_dofs_position(dofs)),
        np.concatenate(pos, axis=-2),
        np.concatenate(quat, axis=-2),
        to_numpy(robot.get_dofs_velocity(dofs)),
        to_numpy(robot.get_dofs_control_force(dofs)),
        to_numpy(robot.get_dofs_force(dofs)),
    )
