"""Runs of a robot's joint as channels: position, velocity and control force, target and limit."""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis.core.channels import Channel, Level, Runs, View
from robo_genesis.core.orderings import Measured
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import listed, said
from robo_genesis.core.trace import Trace
from robo_genesis.sim.joints import JointMap

Metrics = Mapping[str, Mapping[str, Measured]]
"""By case, by name."""

CREDIT = (
    "Franka Emika Panda model of MuJoCo Menagerie, Apache-2.0, from franka_description, "
    "© Franka Robotics GmbH; decimated and converted"
)
"""Of the shape of the robot."""


def channels(traces: Mapping[str, Trace], joints: JointMap, joint: str) -> list[Channel]:
    """Return position, velocity and control force of one joint.

    The force of the first state, before the first step, is what the controller asks for once the
    target has been set.
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
    return [
        Level(
            name="target",
            channel="position",
            mark="target",
            legend="Dotted: the target.",
            values={case: (value,) for case, value in target.items()},
            said={case: said(value, unit) for case, value in target.items()},
            band=band,
        ),
        Level(
            name="force limit",
            channel="control force",
            mark="limit",
            legend="Short dashes, at the edges of the control force: its limits.",
            values={case: (-value, value) for case, value in limit.items()},
            said={case: f"±{said(value, effort, 0)}" for case, value in limit.items()},
        ),
    ]


def runs(
    traces: Mapping[str, Trace],
    links: Sequence[str],
    joints: JointMap,
    joint: str,
    metrics: Metrics,
    band: float,
) -> Runs:
    """Return the runs of one joint with all that is said of them.

    Args:
        traces: by case.
        links: names, in the order of the traces' arrays.
        joints: the map of the traces' arrays.
        joint: whose runs they are.
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
        moves=moving(traces, links, joints, joint, metrics),
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


def moving(
    traces: Mapping[str, Trace],
    links: Sequence[str],
    joints: JointMap,
    joint: str,
    metrics: Metrics,
) -> dict[str, str]:
    """Say for each case, as Markdown, what a viewer would see move, and how it goes."""
    k = joints.entry(joint)
    unit, words = joints.position_units[k], {}
    for case, trace in traces.items():
        far = np.linalg.norm(trace.link_pos - trace.link_pos[0], axis=2).max(axis=0)
        value = {name: format_value(m.value, m.unit) for name, m in metrics[case].items()}
        words[case] = (
            f"**{case}**: `{joint}` starts at {said(trace.q[0, k], unit)} and is told "
            f"to go to {said(trace.target[0, k], unit)}. The link "
            f"`{links[far.argmax()]}` moves farthest, by up to {100 * far.max():.1f} cm. "
            f"Rise time {value['rise_time']}, overshoot {value['overshoot']}, final error "
            f"{value['final_error']}; at the force limit: {value['saturation_samples']}."
        )
    return words
