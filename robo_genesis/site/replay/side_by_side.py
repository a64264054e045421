"""Several runs in one view: the links of each at a place of its own, and all move at once."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.channels import Runs
from robo_genesis.sim.visual_shape import WORLD, Part

OF_LINKS = ("link_pos", "link_quat", "link_vel", "link_ang")
"""The arrays with an axis of links; free bodies have them all, robots the first two."""


def side_by_side(runs: Runs, shape: Sequence[Part]) -> tuple[Runs, list[Part]]:
    """Return runs whose traces all have the links of all runs, and the shape of these links.

    A case then decides which curves are drawn bold, and not what moves.

    Args:
        runs: the runs, each with the links of one robot; their replay has a place for each.
        shape: of the robot; parts of the world remain where they are.

    Raises:
        ValueError: there is not one place for each run.
    """
    places, traces = runs.replay.places, list(runs.traces.items())
    if len(places) != len(traces):
        raise ValueError(
            f"{len(places)} places given for {len(traces)} runs: {', '.join(runs.traces)}. Give "
            "each run a place in the lesson's declaration."
        )
    arrays: dict[str, Any] = {
        name: np.concatenate([getattr(trace, name) for _, trace in traces], axis=1)
        for name in OF_LINKS
        if all(hasattr(trace, name) for _, trace in traces)
    }
    moved = [np.tile([x, y, 0.0], (len(runs.links), 1)) for x, y in places]
    arrays["link_pos"] = arrays["link_pos"] + np.concatenate(moved)
    links = [f"{case}: {link}" for case, _ in traces for link in runs.links]
    parts = [
        replace(part, link=f"{case}: {part.link}")
        for case, _ in traces
        for part in shape
        if part.link != WORLD
    ]
    still = [part for part in shape if part.link == WORLD]
    together = {case: replace(trace, **arrays) for case, trace in traces}
    return replace(runs, traces=together, links=links), [*parts, *still]
