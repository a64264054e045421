"""Metrics of a joint that turns, from its trace alone."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l07.spec import ENTRY
from robo_genesis.sim.arm.joint_control import ControlCase


@dataclass(frozen=True, slots=True)
class TurnMetrics(CaseMetrics):
    """What joint4 did in one run."""

    final_error: float = metric("rad", "distance from the target at the end", "q_rad_or_m")
    peak_speed: float = metric("rad/s", "highest speed", "qd_rad_s_or_m_s")


def turn_metrics(trace: Trace, case: ControlCase) -> TurnMetrics:
    """Measure one run."""
    error = float(trace.target[-1, ENTRY]) - float(trace.q[-1, ENTRY])
    return TurnMetrics(abs(error), float(np.abs(trace.qd[:, ENTRY]).max()))
