"""Several runs in one view: the links of each at a place of its own, and all move at once."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from robo_genesis.core.channels import Run, Runs
from robo_genesis.sim.visual_shape import WORLD, Part


def side_by_side(
    runs: Runs, shape: Sequence[Part], places: Sequence[tuple[float, float]]
) -> tuple[Runs, list[Part]]:
    """Return runs whose traces all have the links of all runs, and the shape of these links.

    A case then decides which curves are drawn bold, and not what moves.

    Args:
        runs: the runs, each with the links of one robot.
        shape: of the robot; parts of the world remain where they are.
        places: by run, how far it is moved along x and y [m].

    Raises:
        ValueError: there is not one place for each run.
    """
    traces = list(runs.traces.items())
    if len(places) != len(traces):
        raise ValueError(
            f"{len(places)} places given for {len(traces)} runs: {', '.join(runs.traces)}. Give "
            "each run a place in the lesson's declaration."
        )
    moved = [
        trace.link_pos.astype(np.float64) + np.array([x, y, 0.0])
        for (_, trace), (x, y) in zip(traces, places, strict=True)
    ]
    positions = np.concatenate(moved, axis=1)
    turns = np.concatenate([trace.link_quat for _, trace in traces], axis=1)
    links = [name_of(case, link) for case, _ in traces for link in runs.links]
    parts = [
        replace(part, link=name_of(case, part.link))
        for case, _ in traces
        for part in shape
        if part.link != WORLD
    ]
    still = [part for part in shape if part.link == WORLD]
    together: dict[str, Run] = {
        case: replace(trace, link_pos=positions, link_quat=turns) for case, trace in traces
    }
    return replace(runs, traces=together, links=links), [*parts, *still]


def name_of(case: str, link: str) -> str:
    """Return the name of a link of one of several runs."""
    return f"{case}: {link}"
