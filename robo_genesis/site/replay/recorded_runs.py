"""The runs of a bundle that a lesson draws and replays."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from robo_genesis.core.channels import Replay, Runs
from robo_genesis.core.text import format_value
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace, read_joints
from robo_genesis.sim.arm import channels as joint_channels
from robo_genesis.sim.bodies import channels as body_channels


def read_runs(folder: Path, replay: Replay, labels: Mapping[str, str]) -> Runs:
    """Return the runs of some cases of one bundle.

    Args:
        folder: of the bundle.
        replay: the cases, and their joint or link.
        labels: words by the name of a case, for some cases; a reader sees them instead.

    Raises:
        BundleRefused: the bundle cannot be read.
        ValueError: it has no such joint, link or axis, or the runs differ in their
            times.
    """
    arrays = bundle.read_arrays(folder)
    links = arrays.coords["link"]
    names = {labels.get(case, case): case for case in replay.cases}
    traces = {
        words: read_any_trace(folder, arrays, case) for words, case in names.items()
    }
    if goal := replay.goal:
        replay = replace(replay, goal=lambda words, k: goal(names[words], k))
    if arrays.joints:
        runs = joint_channels.runs(traces, links, read_joints(arrays), replay)
    else:
        runs = body_channels.runs(traces, links, replay)
    metrics, moves = bundle.read_metrics(folder), {}
    for words, move in runs.moves.items():
        found = metrics.get(names[words], {})
        values = {name: format_value(m.value, m.unit) for name, m in found.items()}
        moves[words] = f"{move} {replay.quality.format(**values)}".rstrip()
    return replace(runs, moves=moves)
