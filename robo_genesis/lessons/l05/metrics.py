"""Distances of the hand from its target, from a trace alone.

Three of them are kept apart: how far the command's own pose is from the target, how far
    the arm is
from the command, and how far the hand is from the target.
"""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.kinematics import (
    Pose,
    distance_and_angle,
    fingertip,
    hand_pose,
    measured_hand,
    overshoot_along_line,
)

from .run import ReachCase

MEASURED, COMMANDED = ("link_pos_m", "link_quat_wxyz"), ("target_rad_or_m",)


@dataclass(frozen=True, slots=True)
class ReachMetrics(CaseMetrics):
    """Where the hand began, where the command would put it, and where it ended."""

    start_distance: float = metric("m", "start to target", *MEASURED)
    command_distance: float = metric("m", "command to target", *COMMANDED)
    command_angle: float = metric("rad", "command to target, angle", *COMMANDED)
    tracking_distance: float = metric("m", "end to command", *MEASURED, *COMMANDED)
    tracking_angle: float = metric(
        "rad", "end to command, angle", *MEASURED, *COMMANDED
    )
    tip_tracking_distance: float = metric(
        "m", "end to command, fingertip", *MEASURED, *COMMANDED
    )
    final_distance: float = metric("m", "end to target", *MEASURED)
    final_angle: float = metric("rad", "end to target, angle", *MEASURED)
    overshoot: float = metric("m", "past the target on the way", *MEASURED)
    final_speed: float = metric(
        "rad/s", "speed of the fastest joint at the end", "qd_rad_s_or_m_s"
    )


def reach_metrics(trace: Trace, case: ReachCase) -> ReachMetrics:
    """Measure a run of a case with all links; its command is constant, at last after the ramp.

    The overshoot is the largest distance beyond the target along the line from the
    start to it.

    Raises:
        IndexError: the trace lacks the hand.
    """
    target, command = Pose(case.position, case.quat), hand_pose(trace.target[-1])
    end, path = measured_hand(trace, -1), measured_hand(trace, slice(None)).position
    return ReachMetrics(  # in the order of its fields
        float(np.linalg.norm(path[0] - case.position)),
        *distance_and_angle(target, command),
        *distance_and_angle(command, end),
        float(np.linalg.norm(fingertip(command) - fingertip(end))),
        *distance_and_angle(target, end),
        overshoot_along_line(path, case.position),
        np.abs(trace.qd[-1]).max(),
    )
