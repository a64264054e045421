"""Distances of the hand from its targets in one environment, from its trace alone."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.kinematics import (
    HAND,
    Pose,
    distance_and_angle,
    hand_pose,
    measured_hand,
    overshoot_along_line,
)

from .run import Environment

MEASURED, COMMANDED = ("link_pos_m", "link_quat_wxyz"), ("target_rad_or_m",)


@dataclass(frozen=True, slots=True)
class WorldMetrics(CaseMetrics):
    """Where the hand began and ended, and whether it moved after the second command was sent."""

    residual: float = metric("m", "last command to its target", *COMMANDED)
    first_distance: float = metric("m", "first target after 1.8 s", *MEASURED)
    final_distance: float = metric(
        "m",
        "last target at the end",
        *MEASURED,
        noun="distance of the hand from its target at the end",
    )
    final_angle: float = metric("rad", "last target at the end, angle", *MEASURED)
    overshoot: float = metric(
        "m",
        "first target passed by",
        "link_pos_m",
        noun="distance by which the hand passes its first target",
    )
    moved_later: float | None = metric("m", "motion after 1.8 s", "link_pos_m")


def world_metrics(trace: Trace, world: Environment) -> WorldMetrics:
    """Measure the run of one environment.

    Raises:
        IndexError: the trace lacks the hand, or ends before its second command.
    """
    first, last = (Pose(world.positions[k], world.quat) for k in (0, -1))
    hand = trace.link_pos[:, HAND].astype(np.float64)
    apart = np.linalg.norm(hand[world.switch :] - hand[world.switch], axis=1)
    return WorldMetrics(  # in the order of its fields
        distance_and_angle(last, hand_pose(trace.target[-1]))[0],
        distance_and_angle(first, measured_hand(trace, world.switch))[0],
        *distance_and_angle(last, measured_hand(trace, -1)),
        overshoot_along_line(hand[: world.switch + 1], first.position),
        apart.max() if len(apart) > 1 else None,
    )
