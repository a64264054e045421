"""The runs of a bundle that a lesson draws and replays."""

from pathlib import Path

from robo_genesis.core.channels import Runs
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import any_bodies, read_joints, read_trace
from robo_genesis.lessons.declaration import Compared, Moving
from robo_genesis.sim import body_channels, joint_channels


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
    links = arrays.coords["link"]
    if isinstance(drawn, Moving):
        bodies = {case: any_bodies(folder, arrays, case) for case in drawn.cases}
        return body_channels.runs(bodies, links, drawn.link, drawn.thing, drawn.axes)
    traces = {case: read_trace(folder, arrays, case) for case in drawn.cases}
    joints, metrics = read_joints(arrays), bundle.read_metrics(folder)
    return joint_channels.runs(traces, links, joints, drawn.joint, metrics, drawn.band)
