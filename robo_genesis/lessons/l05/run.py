"""Reaches of L05: ask for joint positions, accept or refuse them, command them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import DT, FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import franka
from robo_genesis.sim.arm.engine_kinematics import (
    IkAnswer,
    IkSettings,
    accepted_command,
    solve_ik,
)
from robo_genesis.sim.arm.joint_control import (
    ControlCase,
    Controlled,
    assign_postures,
    run_case,
)
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics


@dataclass(frozen=True, slots=True)
class ReachCase(Controlled):
    """A target of the hand, and the controlled arm that is to reach it.

    `position` (3,) [m] and `quat` (4,) are in the world. With `compensated`, each arm
    joint's command is gravity / KP beyond the answer. The command moves on a straight
    line of joint positions during the first `ramp` steps; 0 commands its end at once.
    """

    position: FloatArray
    quat: FloatArray
    settings: IkSettings
    compensated: bool = False
    ramp: int = 0


@dataclass(frozen=True, slots=True)
class SolveCase:
    """Many questions to the solver: target k with start k. The answers are assigned, not commanded.

    `positions` (m, 3) [m] and `quat` (4,) are in the world; `starts` (m, d) [rad or m].
    """

    positions: FloatArray
    quat: FloatArray
    starts: FloatArray
    settings: IkSettings
    dt: float = DT

    @property
    def steps(self) -> int:
        """Number of questions m."""
        return len(self.positions)

    @property
    def start(self) -> ControlCase:
        """The settings from which the answers are assigned: those of the course, at its start."""
        return ControlCase(q_target=franka.Q_START, steps=self.steps, dt=self.dt)


def ask(robot: Any, joints: JointMap, case: ReachCase) -> IkAnswer:
    """Return the engine's answer for the target of a case; the fingers stay at its start."""
    pose = case.position, case.quat
    return solve_ik(robot, joints, *pose, case.q_start, case.settings)


def control_case(case: ReachCase, answer: IkAnswer) -> ControlCase:
    """Return the control case that commands an answer.

    Raises:
        NotAccepted: the answer is not finite, a residual is beyond its tolerance, or
            the fingertips would be too low.
    """
    q_target = accepted_command(answer, case.settings, case.q_start)
    if case.compensated:
        q_target[:ARM] += (mujoco_kinematics.gravity_effort(q_target) / case.kp)[:ARM]
    return case.commanding(command_path(case, q_target))


def command_path(case: ReachCase, q_target: FloatArray) -> FloatArray:
    """Return the command that ends at joint positions (d,): them, or one row for each step."""
    if not case.ramp:
        return q_target
    way = np.linspace(case.q_start, q_target, case.ramp + 1)[1:]
    return np.vstack([way, np.tile(q_target, (case.steps - case.ramp, 1))])


def reach(scene: Any, robot: Any, joints: JointMap, case: ReachCase) -> Trace:
    """Ask for joint positions, and command them if they are accepted.

    Returns:
        The run, whose target is the command.

    Raises:
        NotAccepted: the engine's answer is refused; no command was sent.
    """
    return run_case(scene, robot, joints, control_case(case, ask(robot, joints, case)))


def solve_all(
    scene: Any, robot: Any, joints: JointMap, case: SolveCase
) -> tuple[Trace, FloatArray]:
    """Ask all questions of a case, then assign each answer and read where the links are.

    Returns:
        A trace of the start and the m answers, without steps, and the residuals (m, 6)
        that the engine reported [m and rad].
    """
    questions = zip(case.positions, case.starts, strict=True)
    answers = [
        solve_ik(robot, joints, position, case.quat, start, case.settings)
        for position, start in questions
    ]
    postures = np.stack([answer.q for answer in answers]).astype(np.float64)
    trace = assign_postures(scene, robot, joints, case.start, postures)
    return trace, np.stack([answer.error for answer in answers])
