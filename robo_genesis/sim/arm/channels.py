"""Runs of a joint as channels, or the distance of the hand from its goal, with levels."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from robo_genesis.core.channels import Channel, Level, Replay, Runs
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import with_unit
from robo_genesis.core.trace import Trace

from .joints import JointMap

MEASURES = False


def runs(
    traces: Mapping[str, Trace], links: Sequence[str], joints: JointMap, replay: Replay
) -> Runs:
    """Return the runs of a robot with their descriptions.

    Args:
        traces: by case.
        links: names, in the order of the traces' arrays.
        joints: of the DOFs.
        replay: what is shown of them.

    Raises:
        ValueError: the record has no such joint or link; as `Runs`.
    """
    followed, described = replay.follows, dict.fromkeys(traces, "")
    marks: list[Level] = []
    if followed in links:
        subject, drawn = f"the {replay.thing}", [height(traces, links.index(followed))]
    else:
        described = {n: f" {motion(of, joints, followed)}" for n, of in traces.items()}
        if replay.goal:
            subject = "the hand"
            drawn = distances(traces, links, replay.goal, replay.hand)
        else:
            subject, drawn = followed, channels(traces, joints, followed)
            marks = levels(traces, joints, followed, replay.band)
    return Runs(
        replay,
        subject,
        traces=traces,
        links=links,
        channels=drawn,
        levels=marks,
        moves={case: f"**{case}**:{text}" for case, text in described.items()},
    )


def channels(
    traces: Mapping[str, Trace], joints: JointMap, joint: str
) -> list[Channel]:
    """Return position, velocity and control force of one joint.

    The force of the first state is that of the controller after the target has been set
    and before the first step.
    """
    k = joints.entry(joint)
    unit, effort = joints.position_units[k], joints.effort_units[k]
    q = {case: trace.q[:, k] for case, trace in traces.items()}
    qd = {
        case: np.append(trace.start_qd[k], trace.qd[:, k])
        for case, trace in traces.items()
    }
    force = {
        case: np.append(trace.start_control_force[k], trace.control_force[:, k])
        for case, trace in traces.items()
    }
    return [
        Channel("position", "q", unit, 4, q),
        Channel("velocity", "q̇", f"{unit}/s", 4, qd),
        Channel("control force", "force", effort, 2, force),
    ]


def height(traces: Mapping[str, Trace], link: int) -> Channel:
    """Return the height of the origin of a link of the robot, or of a body beside it."""
    heights = {
        case: 1000 * trace.link_pos[:, link, 2] for case, trace in traces.items()
    }
    return Channel("height", "z", "mm", 1, heights)


def distances(
    traces: Mapping[str, Trace],
    links: Sequence[str],
    goal: Callable[[str, int], FloatArray],
    hand: str,
) -> list[Channel]:
    """Return the distance of the hand from its goal, which each state has."""
    found = {}
    for case, trace in traces.items():
        goals = [goal(case, k) for k in range(len(trace.t))]
        apart = trace.link_pos[:, links.index(hand)] - goals
        found[case] = 1000 * np.linalg.norm(apart, axis=1)
    return [Channel("distance from the target", "distance", "mm", 1, found)]


def levels(
    traces: Mapping[str, Trace], joints: JointMap, joint: str, band: float
) -> list[Level]:
    """Return the target with its settling band of half width `band`, and the force limit."""
    k = joints.entry(joint)
    unit, effort = joints.position_units[k], joints.effort_units[k]
    values = {case: targets(trace, k) for case, trace in traces.items()}
    limit = {case: float(trace.effort_limit[k]) for case, trace in traces.items()}
    texts = {case: one_by_one(found, unit, ",\n") for case, found in values.items()}
    limits = {case: (-value, value) for case, value in limit.items()}
    limit_texts = {
        case: f"±{with_unit(value, effort, 0)}" for case, value in limit.items()
    }
    legend = "Short dashes, at the edges of the control force: its limits."
    return [
        Level(
            "target", "position", "target", "Dotted: the target.", values, texts, band
        ),
        Level("force limit", "control force", "limit", legend, limits, limit_texts),
    ]


def motion(trace: Trace, joints: JointMap, joint: str) -> str:
    """Return a sentence with the start and the targets of one joint."""
    k = joints.entry(joint)
    unit = joints.position_units[k]
    start, target = with_unit(trace.q[0, k], unit), one_by_one(targets(trace, k), unit)
    return f"`{joint}` starts at {start} and gets the target {target}."


def targets(trace: Trace, entry: int) -> tuple[float, ...]:
    """Return the commands of one joint in their order, equal ones in a row once."""
    command = trace.target[:, entry]
    begins = [0, *(np.flatnonzero(np.diff(command)) + 1).tolist()]
    return tuple(float(command[k]) for k in begins)


def one_by_one(values: Sequence[float], unit: str, between: str = ", then ") -> str:
    """Return values in their order as text: `0.5 rad, then 0.7 rad`. Of many, it is the ends."""
    some = values if len(values) < 4 else [values[0], values[-1]]
    more = "" if some is values else f" ({len(values)} values)"
    return between.join(with_unit(value, unit) for value in some) + more
