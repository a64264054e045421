"""Runs of a joint as channels: position, velocity, control force, target and effort limit."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from robo_genesis.core.channels import Channel, Level, Runs, View, farthest_link
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import listed, said
from robo_genesis.core.trace import Trace
from robo_genesis.sim.joints import JointMap

Metrics = Mapping[str, Mapping[str, Any]]
"""By case and name, each with `value` and `unit`."""

CREDIT = (
    "Franka Emika Panda model of MuJoCo Menagerie, Apache-2.0, from franka_description, "
    "© Franka Robotics GmbH; decimated and converted"
)
"""Of the shape of the robot."""


def channels(traces: Mapping[str, Trace], joints: JointMap, joint: str) -> list[Channel]:
    """Return position, velocity and control force of one joint.

    The force of the first state is that of the controller after the target has been set and before
    the first step.
    """
    k = joints.entry(joint)
    unit, effort = joints.position_units[k], joints.effort_units[k]
    q = {case: trace.q[:, k] for case, trace in traces.items()}
    qd = {case: np.append(trace.start_qd[k], trace.qd[:, k]) for case, trace in traces.items()}
    force = {
        case: np.append(trace.start_control_force[k], trace.control_force[:, k])
        for case, trace in traces.items()
    }
    return [
        Channel("position", "q", unit, 4, q),
        Channel("velocity", "q̇", f"{unit}/s", 4, qd),
        Channel("control force", "force", effort, 2, force),
    ]


def levels(traces: Mapping[str, Trace], joints: JointMap, joint: str, band: float) -> list[Level]:
    """Return the target with its settling band of half width `band`, and the force limit."""
    k = joints.entry(joint)
    unit, effort = joints.position_units[k], joints.effort_units[k]
    target = {case: float(trace.target[0, k]) for case, trace in traces.items()}
    limit = {case: float(trace.effort_limit[k]) for case, trace in traces.items()}
    values = {case: (value,) for case, value in target.items()}
    texts = {case: said(value, unit) for case, value in target.items()}
    limits = {case: (-value, value) for case, value in limit.items()}
    limit_texts = {case: f"±{said(value, effort, 0)}" for case, value in limit.items()}
    legend = "Short dashes, at the edges of the control force: its limits."
    return [
        Level("target", "position", "target", "Dotted: the target.", values, texts, band),
        Level("force limit", "control force", "limit", legend, limits, limit_texts),
    ]


def runs(
    traces: Mapping[str, Trace],
    links: Sequence[str],
    joints: JointMap,
    joint: str,
    metrics: Metrics,
    band: float,
) -> Runs:
    """Return the runs of one joint with their descriptions.

    Args:
        traces: by case.
        links: names, in the order of the traces' arrays.
        joints: the map of the traces' arrays.
        joint: the joint of the channels.
        metrics: of each case.
        band: half width of the settling band, in the joint's unit.

    Raises:
        JointError: the map has no such joint.
        ValueError: as `Runs`.
    """
    return Runs(
        subject=joint,
        traces=traces,
        links=links,
        channels=channels(traces, joints, joint),
        levels=levels(traces, joints, joint, band),
        moves={
            case: f"**{case}**: {_motion(trace, joints, joint)} {farthest_link(links, trace)} "
            + _quality({name: format_value(m.value, m.unit) for name, m in metrics[case].items()})
            for case, trace in traces.items()
        },
        view=View(
            thing="robot",
            alt=f"The robot in 3D, in the posture of the sample that is shown. {joint} moves.",
            credit=CREDIT,
            orbit="45deg 72deg 90%",
            target="0.2m 0.52m 0m",
        ),
        alt=f"Position of {joint} over time with the gains of {listed(list(traces))}, its target "
        "and the settling band around it.",
        caption=f"Position of {joint}, three settings of its controller, from get_dofs_position.",
    )


def _motion(trace: Trace, joints: JointMap, joint: str) -> str:
    k = joints.entry(joint)
    start, target = (said(q, joints.position_units[k]) for q in (trace.q[0, k], trace.target[0, k]))
    return f"`{joint}` starts at {start} and gets the target {target}."


def _quality(metrics: Mapping[str, str]) -> str:
    return (
        f"Rise time {metrics['rise_time']}, overshoot {metrics['overshoot']}, final error "
        f"{metrics['final_error']}; at the force limit: {metrics['saturation_samples']}."
    )
