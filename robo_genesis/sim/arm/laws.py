"""Laws of a position-controlled robot: the control law, and forward kinematics.

MuJoCo computes the poses of the links from the same model file, in float64. Forces grow
with KP, and so does their tolerance from `STIFF` on.

| tolerance | residual of the CPU runs | value |
|---|---|---|
| `LAW`, control force: float32 in KP times a position error | 4e-4 N·m | 4e-3 N·m |
| `POSE`, link positions and quaternions | 2.3e-7 m, 2.2e-7 | 2.5e-6 |
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from robo_genesis.core.check_spec import LIMIT_TOLERANCE
from robo_genesis.core.checks import Findings
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.laws import apart

from .joint_control import ControlCase
from .model import RobotModel

MEASURES = False

LAW, POSE = 4e-3, 2.5e-6

# KP up to which rounding of a position stays within the tolerance [N·m/rad or N/m]
STIFF = 1e4


def driven_run(trace: Trace, case: ControlCase, links: Sequence[str]) -> Findings:
    """Yield what no run with a commanded target has, whatever engine steps.

    Of a robot whose base moves freely nothing is known about where its links are.

    Args:
        trace: the run.
        case: its settings.
        links: names of its first links, those of the robot.

    Raises:
        ModelError: MuJoCo cannot read the robot's model.
    """
    command = np.broadcast_to(case.q_target, trace.target.shape)
    of_states = replace(case, q_target=np.vstack([command[:1], command]))
    qd = np.vstack([trace.start_qd, trace.qd])
    force = np.vstack([trace.start_control_force, trace.control_force])
    room = LAW * np.maximum(1.0, case.kp / STIFF)
    law = control_law(of_states, trace.q, qd)
    yield from apart("control_force [N·m or N]", force, law, room)
    limits = trace.effort_limit, case.effort_limit
    room = LIMIT_TOLERANCE * case.effort_limit
    yield from apart("effort_limit [N·m or N]", *limits, room)
    if not case.model.free_base:
        yield from poses(trace, links, case.model)


def assigned_run(trace: Trace, links: Sequence[str], model: RobotModel) -> Findings:
    """Yield what no run of `joint_control.assign_postures` has: its states are assigned."""
    yield from apart("q [rad or m]", trace.q[1:], trace.target, LIMIT_TOLERANCE)
    yield from poses(trace, links, model)


def control_law(case: ControlCase, q: FloatArray, qd: FloatArray) -> FloatArray:
    """Return clip(KP (q_target − q) − KV q̇) of states (…, d) [N·m or N]."""
    effort = case.kp * (case.q_target - q) - case.kv * qd
    return np.clip(effort, -case.effort_limit, case.effort_limit)


def poses(trace: Trace, links: Sequence[str], model: RobotModel) -> Findings:
    """Yield a link that is not where the joints put it; further links may follow these."""
    from robo_genesis.sim.mujoco.kinematics import link_poses  # a page measures without

    position, quat = link_poses(trace.q, links, model)
    found = trace.link_quat[:, : len(links)]
    cosine = (quat * found).sum(-1, keepdims=True)  # −q is the rotation q
    same = np.where(cosine < 0, -quat, quat)
    yield from apart("link_pos [m]", trace.link_pos[:, : len(links)], position, POSE)
    yield from apart("link_quat", found, same, POSE)
