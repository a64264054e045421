"""The runs of a bundle that a lesson draws and replays."""

from pathlib import Path

from robo_genesis.core.channels import Runs, farthest_link
from robo_genesis.core.declaration import Compared, Moving
from robo_genesis.core.text import format_value
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import any_bodies, read_joints, read_trace
from robo_genesis.sim.arm import channels as joint_channels
from robo_genesis.sim.bodies import channels as body_channels


def read_runs(folder: Path, drawn: Compared | Moving) -> Runs:
    """Return the runs of some cases of one bundle.

    Args:
        folder: of the bundle.
        drawn: the cases, and their joint or link.

    Raises:
        BundleRefused: the bundle cannot be read, or has no runs of this kind.
        ValueError: it has no such joint, link or axis, or the runs differ in their times.
    """
    arrays = bundle.read_arrays(folder)
    if isinstance(drawn, Compared):
        return _joint_runs(folder, arrays, drawn)
    bodies = {case: any_bodies(folder, arrays, case) for case in drawn.cases}
    links = arrays.coords["link"]
    return body_channels.runs(bodies, links, drawn.link, drawn.thing, drawn.axes)


def _joint_runs(folder: Path, arrays: bundle.Arrays, drawn: Compared) -> Runs:
    traces = {case: read_trace(folder, arrays, case) for case in drawn.cases}
    links, joints, joint = arrays.coords["link"], read_joints(arrays), drawn.joint
    metrics, moves = bundle.read_metrics(folder), {}
    for case, trace in traces.items():
        values = {name: format_value(m.value, m.unit) for name, m in metrics[case].items()}
        moves[case] = (
            f"**{case}**: {joint_channels.motion(trace, joints, joint)} "
            f"{farthest_link(links, trace)} {drawn.quality.format(**values)}"
        )
    return Runs(
        subject=joint,
        traces=traces,
        links=links,
        channels=joint_channels.channels(traces, joints, joint),
        levels=joint_channels.levels(traces, joints, joint, drawn.band),
        moves=moves,
        view=drawn.view,
        alt=drawn.alt,
        caption=drawn.caption,
    )
