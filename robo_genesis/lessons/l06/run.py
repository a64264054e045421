"""Runs of L06: ask, accept and command all environments of a scene, or some of them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.batch import Batch
from robo_genesis.sim.arm.engine_kinematics import (
    IkAnswer,
    IkSettings,
    accepted_command,
    solve_ik,
)
from robo_genesis.sim.arm.joint_control import Controlled
from robo_genesis.sim.arm.joints import JointMap


@dataclass(frozen=True, slots=True)
class Environment(Controlled):
    """One environment: the targets of its hand in their order, its controlled arm, and its load.

    `positions` (p, 3) [m] and `quat` (4,) are in the world. A second target is
    commanded after `switch` of the `steps`. `load` is added to the mass of the hand
    [kg].
    """

    positions: FloatArray
    quat: FloatArray
    settings: IkSettings
    switch: int
    load: float = 0.0


def ask(
    robot: Any,
    joints: JointMap,
    worlds: Sequence[Environment],
    number: int = 0,
    envs: Sequence[int] | None = None,
) -> IkAnswer:
    """Ask in one call for a target of each world; row k of the answer belongs to `worlds[k]`.

    Args:
        robot: of a scene with environments, or of one without for a single world.
        joints: all its joints.
        worlds: the questions, all with equal settings of the solver.
        number: of the target in `positions`.
        envs: the environments of the worlds; 0, 1 … by default.
    """
    rows = [(world.positions[number], world.quat, world.q_start) for world in worlds]
    position, quat, q_start = (np.stack(values) for values in zip(*rows, strict=True))
    if robot.scene.n_envs == 0:
        position, quat, q_start = position[0], quat[0], q_start[0]
    found = solve_ik(robot, joints, position, quat, q_start, worlds[0].settings, envs)
    return IkAnswer(
        found.q.reshape(len(worlds), -1), found.error.reshape(len(worlds), -1)
    )


def commands(worlds: Sequence[Environment], answer: IkAnswer) -> FloatArray:
    """Return the joint positions (k, d) that accepted answers command; the fingers stay.

    Raises:
        NotAccepted: an answer is not finite, or a residual is beyond its tolerance.
    """
    starts = np.stack([world.q_start for world in worlds])
    return accepted_command(answer, worlds[0].settings, starts)


def start(
    scene: Any, robot: Any, joints: JointMap, worlds: Sequence[Environment]
) -> Batch:
    """Reset every environment to the start of its world, with its gains."""
    return Batch(
        scene, robot, joints, [world.commanding(world.q_start) for world in worlds]
    )


def reach(
    scene: Any, robot: Any, joints: JointMap, worlds: Sequence[Environment]
) -> list[Trace]:
    """Command the first target of all worlds, later the second target of those that have one.

    Returns:
        The run of each world, in their order.
    """
    batch = start(scene, robot, joints, worlds)
    batch.command(commands(worlds, ask(robot, joints, worlds)))
    batch.step(worlds[0].switch)
    envs = [k for k, world in enumerate(worlds) if len(world.positions) > 1]
    if envs:
        again = [worlds[k] for k in envs]
        some = envs if scene.n_envs else None
        batch.command(commands(again, ask(robot, joints, again, 1, some)), envs)
    batch.step(worlds[0].steps - worlds[0].switch)
    return [batch.trace(k) for k in range(len(worlds))]


def reset_some(
    scene: Any,
    robot: Any,
    joints: JointMap,
    worlds: Sequence[Environment],
    envs: Sequence[int],
    after: int,
) -> Iterator[Batch]:
    """Reset some environments after some steps, and command their first target again.

    Yields:
        The batch before the reset, after it, one step later, and after `switch` further
        steps. Its traces of `envs` begin at their last reset, the others at the start.
    """
    batch = start(scene, robot, joints, worlds)
    q_target = commands(worlds, ask(robot, joints, worlds))
    batch.command(q_target)
    batch.step(after)
    yield batch
    batch.reset_rows(envs)
    batch.command(q_target[list(envs)], envs)
    for steps in (0, 1, worlds[0].switch - 1):
        batch.step(steps)
        yield batch
