"""Inverse kinematics, link poses and Jacobian of a robot in Genesis."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from robo_genesis.core.scene import FloatArray

from .franka import FRANKA
from .joints import JointMap, require_whole, to_numpy
from .kinematics import accepted, distances, fingertip, hand_pose
from .model import RobotModel

END_EFFECTOR = FRANKA.hand


class NotAccepted(ValueError):  # noqa: N818 - read aloud: not accepted
    """An answer is not finite or too far from its target; nothing was commanded."""


@dataclass(frozen=True, slots=True)
class IkSettings:
    """Settings of the engine's solver. All are given to it, because its defaults may change.

    It stops when both residuals are within `position_tolerance` [m] and
    `rotation_tolerance` [rad]. After `iterations` it draws another start within the
    joint limits, up to `samples` starts with the given one. With `samples=1` it draws
    nothing, so equal calls give equal answers. `clearance` is not for the solver: the
    least height of the fingertips of an accepted command [m].
    """

    position_tolerance: float = 5e-4
    rotation_tolerance: float = 5e-3
    samples: int = 50
    iterations: int = 20
    damping: float = 0.01
    largest_step: float = 0.5
    clearance: float = 0.03

    @property
    def tolerances(self) -> tuple[float, float]:
        """Return the largest accepted residuals of position [m] and rotation [rad]."""
        return self.position_tolerance, self.rotation_tolerance


class IkAnswer(NamedTuple):
    """What the engine's solver returned, accepted or not.

    `q` (…, d) has the order of the joint map. `error` (…, 6) leads from the pose of the
    answer to the target: a translation [m] and a rotation vector [rad], both in the
    axes of the world. The leading axis has one row for each environment; without
    environments there is none.
    """

    q: FloatArray
    error: FloatArray


def solve_ik(
    robot: Any,
    joints: JointMap,
    position: FloatArray,
    quat: FloatArray,
    q_start: FloatArray,
    settings: IkSettings,
    envs: Sequence[int] | None = None,
    of: RobotModel = FRANKA,
) -> IkAnswer:
    """Ask the engine for joint positions that bring the hand to a pose. Nothing is commanded.

    In a scene with environments all arrays have one row for each asked environment, and
    so has the answer.

    Args:
        robot: rigid entity of a built scene.
        joints: all its joints.
        position: (…, 3) target of the hand's origin in the world [m].
        quat: (…, 4) target orientation, (w, x, y, z).
        q_start: (…, d) first start [rad or m].
        settings: of the solver.
        envs: numbers of the environments that are asked, all by default.
        of: the robot, whose fingers the solver does not move.

    Raises:
        ModelError: the robot has further DOFs, such as those of a free base.
    """
    require_whole(robot, joints)
    in_model_order = np.empty(np.shape(q_start), dtype=np.float32)
    in_model_order[..., joints.qs_idx_local] = q_start
    chosen = {} if envs is None else {"envs_idx": list(envs)}
    moved = of.joints[: of.arm]
    dofs = [int(joints.dofs_idx_local[joints.entry(name)]) for name in moved]
    q, error = robot.inverse_kinematics(
        link=robot.get_link(of.hand),
        pos=np.array(position, dtype=np.float32),
        quat=np.array(quat, dtype=np.float32),
        init_qpos=in_model_order,
        respect_joint_limit=True,
        max_samples=settings.samples,
        max_solver_iters=settings.iterations,
        damping=settings.damping,
        pos_tol=settings.position_tolerance,
        rot_tol=settings.rotation_tolerance,
        max_step_size=settings.largest_step,
        dofs_idx_local=dofs,
        return_error=True,
        **chosen,
    )
    return IkAnswer(to_numpy(q)[..., joints.qs_idx_local], to_numpy(error))


def tip_height(q: FloatArray, of: RobotModel = FRANKA) -> FloatArray:
    """Return the height (…) of the ends of a robot's fingers at joint positions (…, d) [m]."""
    return fingertip(hand_pose(q, of), of.tip)[..., 2]


def accepted_command(
    answer: IkAnswer, settings: IkSettings, q_start: FloatArray, of: RobotModel = FRANKA
) -> FloatArray:
    """Return the joint positions (…, d) that accepted answers command; the fingers stay.

    Args:
        answer: of one question, or with a row for each.
        settings: of the solver, with the tolerances of both residuals and the least
            clearance.
        q_start: (…, d) joint positions with those of the fingers [rad or m].
        of: the robot.

    Raises:
        NotAccepted: an answer is not finite, a residual is beyond its tolerance, or the
            fingertips would be too low; the message names the rows, and gives the
            largest residuals and the lowest height.
    """
    height = tip_height(answer.q, of)
    near = accepted(answer.q, answer.error, *settings.tolerances)
    refused = ~(near & (height >= settings.clearance))
    if refused.any():
        rows = np.flatnonzero(refused).tolist()
        apart, angle = (np.max(of) for of in distances(answer.error[refused]))
        raise NotAccepted(
            f"{f'Rows {rows} are' if refused.ndim else 'The answer is'} refused. The residual is "
            f"{apart:.3g} m and {angle:.3g} rad, accepted are {settings.position_tolerance:g} m "
            f"and {settings.rotation_tolerance:g} rad with finite joint positions. The height of "
            f"the fingertips is {np.min(height[refused]):.3g} m, accepted is "
            f"{settings.clearance:g} m. Nothing is commanded: choose another target, or another "
            "start of the solver."
        )
    q = answer.q.astype(np.float64)
    q[..., of.arm :] = q_start[..., of.arm :]
    return q


def jacobian(robot: Any, joints: JointMap, link: str = END_EFFECTOR) -> FloatArray:
    """Return the Jacobian (6, d) of the origin of a link, by default the hand, in the state now.

    The first three rows are its velocity, the others its angular velocity, in the
    world's axes.
    """
    found = to_numpy(robot.get_jacobian(link=robot.get_link(link)))
    return found[:, joints.dofs_idx_local]
