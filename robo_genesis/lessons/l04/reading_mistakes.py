"""Two ways to misread a run that was measured well: the wrong getter, and stamps one step early."""

from dataclasses import replace

import numpy as np

from robo_genesis.core.mistakes import Failure
from robo_genesis.core.quantities import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.lessons.l04.mistakes import SMALL
from robo_genesis.sim.joints import JointMap


def wrong_getter(trace: Trace, joints: JointMap, joint: str) -> Failure:
    """Read the net force at the end of a run as what the motor gives."""
    k = joints.entry(joint)
    net, control = float(trace.internal_force[-1, k]), float(trace.control_force[-1, k])
    unit = joints.effort_units[k]
    return Failure(
        "wrong_getter",
        shown=abs(net) < SMALL * abs(control),
        evidence=(
            f"At the last sample `get_dofs_force` is {format_value(net, unit)} and "
            f"`get_dofs_control_force` is {format_value(control, unit)}."
        ),
    )


def time_shift(trace: Trace, joints: JointMap, joint: str) -> Failure:
    """Label the first state after a step as t = 0, and measure again."""
    k = joints.entry(joint)
    late = {name: getattr(trace, name)[1:] for name in ("q", "link_pos", "link_quat")}
    late |= {n: getattr(trace, n)[1:] for n in ("qd", "target", "control_force", "internal_force")}
    shifted = step_metrics(replace(trace, t=trace.t[:-1], **late), k)  # the mistake
    right = step_metrics(trace, k)
    told, gaps = [], []
    for name, one, other in (
        ("rise time", right.rise_time, shifted.rise_time),
        ("settling time", right.settling_time, shifted.settling_time),
    ):
        told.append(f"{name} {format_value(other, 's')} instead of {format_value(one, 's')}")
        gaps += [one - other] if one is not None and other is not None else []
    return Failure(
        "time_shift",
        shown=bool(gaps) and np.allclose(gaps, trace.dt, rtol=0, atol=1e-9),
        evidence=f"With one and the same curve, the shifted stamps give {' and '.join(told)}.",
    )
