"""Metrics of a scene at rest and of a lift, each from its trace alone."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.kinematics import HAND
from robo_genesis.sim.arm.lifting import ENDS
from robo_genesis.sim.bodies.table import SceneCase

# Indices of both bodies among the links of the arrays, after those of the robot.
OBJECT, BALL = 11, 12

WINDOW = 20  # Steps at the end in which an object at rest keeps its place


@dataclass(frozen=True, slots=True)
class SceneMetrics(CaseMetrics):
    """What one run shows of its object; the metrics of the other kind of run are None.

    Both rises count from the end of closing; `tilt` is that of the object at the end.
    """

    support: float | None = metric("m", "support error", "link_pos_m")
    drift: float | None = metric("m", "drift", "link_pos_m")
    moved: float | None = metric("m", "moved in the last 0.2 s", "link_pos_m")
    ball: float | None = metric("m", "height of the ball's lowest point", "link_pos_m")
    pushed: float | None = metric("m", "pushed before closing", "link_pos_m")
    rise: float | None = metric("m", "rise of the object", "link_pos_m")
    hand_rise: float | None = metric("m", "rise of the hand", "link_pos_m")
    tilt: float | None = metric("rad", "tilt of the object", "link_quat_wxyz")


def lifts(case: SceneCase) -> bool:
    """Return whether a case is a lift, which has the steps of all its phases."""
    return bool(case.steps == ENDS["hold"])


def scene_metrics(trace: Trace, case: SceneCase) -> SceneMetrics:
    """Measure one run of a scene."""
    at = trace.link_pos[:, OBJECT].astype(np.float64)
    if not lifts(case):
        support = at[-1, 2] - case.size[2] / 2 - case.place[2]
        apart = np.linalg.norm(at - at[0], axis=1)[-1]
        window = np.ptp(at[-WINDOW - 1 :], axis=0).max()
        ball = trace.link_pos[-1, BALL, 2] - case.ball_radius
        return SceneMetrics(*map(float, (support, apart, window, ball)), *[None] * 4)
    before, opened, shut = (ENDS[name] for name in ("approach", "settle", "close"))
    hand = trace.link_pos[:, HAND, 2].astype(np.float64)
    pushed = np.linalg.norm(at[opened] - at[before])
    tilt = 2 * np.arcsin(np.hypot(*trace.link_quat[-1, OBJECT, 1:3]))
    lifted = at[-1, 2] - at[shut, 2], hand[-1] - hand[shut], tilt
    return SceneMetrics(*[None] * 4, *map(float, (pushed, *lifted)))
