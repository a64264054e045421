"""What the pages of L08 record of their batches."""

from dataclasses import fields
from typing import Any

import numpy as np

from robo_genesis.core.trace import Demonstrations, Episodes
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.batch import Batch
from robo_genesis.sim.arm.joints import describe
from robo_genesis.sim.bodies.table import World
from robo_genesis.sim.camera import film, frames

from . import spec


def episodes(
    page: Any, gs: Any, *names: str | tuple[str, ...], **cameras: dict[str, Any]
) -> tuple[World, Batch]:
    """Record batches of a page that one scene can run, one after the other.

    Args:
        page: an open page.
        gs: the engine after `gs.init`.
        names: of the page's cases. Those of a tuple run at the same time, each in its
            own environments.
        cameras: arguments of each; see `table.build`.

    Returns:
        The scene, and the batch of the first run.
    """
    cases = page.experiment.cases
    groups = [(of,) if isinstance(of, str) else of for of in names]
    runs = [picking.together([cases[name] for name in group]) for group in groups]
    world = picking.build(gs, runs[0], **cameras)
    joints = describe(page, world.robot)
    page.links = [*page.links, "object"]
    batches = []
    for group, case in zip(groups, runs, strict=True):
        trace, batch = picking.run(world, joints, case)
        batches.append(batch)
        first = 0
        for name in group:
            first, begin = first + len(cases[name].starts), first
            page.traces[name] = trace.of(slice(begin, first))
    return world, batches[0]


def keep(page: Any, batch: Batch) -> None:
    """Give a page all states of the episodes that its replay or its schematic shows."""
    rows = {
        name: row
        for name, (_, row) in spec.ROWS.items()
        if name in page.experiment.cases
    }
    page.traces |= {name: batch.trace(row) for name, row in rows.items()}


def demonstrate(page: Any, world: World, batch: Batch) -> None:
    """Keep the commands of the lab's batch, and film some of its episodes.

    For the films, the first environment takes the recorded states one after the other.
    """
    trace, every = page.traces["exact"], spec.EXACT.commands
    parts = {of.name: getattr(trace, of.name) for of in fields(Episodes)}
    target = np.stack(batch.sent)[every - 1 :: every].astype(np.float32)
    page.traces["exact"] = Demonstrations(**parts, target=target)
    for row, name in enumerate(spec.FILMS if page.render else ()):
        pictures = []
        for k in range(len(trace.t)):
            picking.pose(
                world,
                page.joints,
                *(of[k, row] for of in (trace.q, trace.object_pos, trace.object_quat)),
            )
            pictures.append(frames.capture(world.cameras["film"], film.PICTURE))
        page.frames |= film.sheets(name, np.stack(pictures))
