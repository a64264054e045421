"""What the pages of L08 record of their batches."""

from typing import Any

from robo_genesis.lessons.l08 import spec
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.batch import Batch
from robo_genesis.sim.arm.joints import describe
from robo_genesis.sim.bodies.table import World


def episodes(
    page: Any, gs: Any, *names: str, view: dict[str, Any] | None = None
) -> tuple[World, Batch]:
    """Record batches of a page that differ in starts and beliefs alone, one after the other.

    Args:
        page: an open page.
        gs: the engine after `gs.init`.
        names: of the page's cases.
        view: arguments of a camera, None without one.

    Returns:
        The scene, and the batch of the first case.
    """
    cases = page.experiment.cases
    world = picking.build(gs, cases[names[0]], view)
    joints = describe(page, world.robot)
    page.links = [*page.links, "object"]
    runs = {name: picking.run(world, joints, cases[name]) for name in names}
    page.traces |= {name: trace for name, (trace, _) in runs.items()}
    return world, runs[names[0]][1]


def keep(page: Any, batch: Batch) -> None:
    """Give a page all states of the episodes that its replay shows."""
    page.traces |= {name: batch.trace(row) for name, row in spec.SHOWN.items()}
