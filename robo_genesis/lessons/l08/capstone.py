"""The capstone: an object and a camera of one's own, and runs that test a claim about them."""

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import FUNCTIONS
from robo_genesis.core.experiment import json_value
from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.scene import FloatArray, read_only
from robo_genesis.core.trace import Episodes
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.joints import describe
from robo_genesis.sim.arm.picking import PickCase

from . import metrics, spec

# The course's own answer; its page has it as functions.
SIZE = (0.04, 0.066, 0.09)
ABOVE = 0.6  # Height of its camera above the table [m]
MOVED = (0.42, 0.62), (-0.28, 0.02)  # Region of the new starts, as `spec.REGION`


def seen(places: FloatArray) -> FloatArray:
    """Return where a camera above the middle sees tops of objects at places (e, 2) [m]."""
    apart = (places - spec.MIDDLE) * ABOVE / (ABOVE - SIZE[2])
    return read_only(spec.MIDDLE + apart)


def cases() -> dict[str, PickCase]:
    """Return the runs of the course's own answer by name."""
    starts, new = spec.starts(8, 11), spec.starts(8, 23, MOVED)
    believed = seen(starts)
    own = replace(
        spec.EXACT,
        shape="box",
        size=SIZE,
        density=1000.0,
        friction=0.9,
        starts=starts,
        beliefs=believed,
    )
    x_exact = np.where([True, False], starts, believed)
    y_exact = np.where([False, True], starts, believed)
    return {
        "own": own,
        "without_cause": replace(own, beliefs=y_exact),
        "without_rival": replace(own, beliefs=x_exact),
        "attack": replace(own, starts=new, beliefs=seen(new)),
    }


CASES = cases()


@dataclass(frozen=True, slots=True)
class AttemptMetrics(CaseMetrics):
    """How many episodes succeed, and how many the hand touches too early."""

    resting: float = metric("1", "success", *metrics.RELEASED)
    touched: float = metric("1", "touched before the fingers close", "phase", "touches")
    touched_lost: float = metric("1", "of these, failed", *metrics.RELEASED)


def attempt_metrics(trace: Episodes, case: PickCase) -> AttemptMetrics:
    """Count episodes of one batch."""
    good = metrics.good(trace, case)
    early = (trace.touches * (trace.phase < picking.CLOSE)).any(axis=0)
    return AttemptMetrics(good.sum(), early.sum(), (early & ~good).sum())


def settings_changed(one: PickCase, other: PickCase) -> list[str]:
    """Return the names of the settings in which two cases differ."""
    a, b = (json_value(asdict(case)) for case in (one, other))
    return [name for name in a if a[name] != b[name]]


class Work:
    """The runs of a page whose cases its reader chooses; they replace the declared ones.

    Args:
        page: an open page.
        gs: the engine after `gs.init`.
    """

    def __init__(self, page: Any, gs: Any) -> None:
        self.page, self.gs = page, gs
        self.case: Any = None
        self.world: Any = None

    def run(self, name: str, case: PickCase) -> Episodes:
        """Let the expert work in all environments of a case, and keep the run by its name.

        A scene is built unless the last one differs in starts and beliefs alone.
        """
        page, runs = self.page, self.page.experiment.page.runs
        if not (
            self.case
            and len(self.case.starts) == len(case.starts)
            and {*settings_changed(self.case, case)} <= {"starts", "beliefs"}
        ):
            self.world = picking.build(self.gs, case, spec.VIEW)
        self.case, world = case, self.world
        joints = describe(page, world.robot)
        page.links = [*page.links, "object"]
        trace, batch = picking.run(world, joints, case)
        runs[name], page.traces[name] = replace(runs[name], case=case), trace
        if name == "own":
            runs["first"] = replace(runs["first"], case=case.episode(0))
            page.traces["first"] = batch.trace(0)
            page.capture(world.cameras["world"], "final")
            world.scene.reset()
            page.capture(world.cameras["world"], "initial")
        return trace

    def finish(self) -> None:
        """Finish the page if each function passed its test; otherwise name those that are left."""
        found = self.page.experiment.readings[FUNCTIONS]
        if left := [name for name, passed in found.items() if not passed]:
            print(f"L08 CHECK: INCOMPLETE, not passed: {', '.join(left)}")
        else:
            self.page.finish(self.world.scene)
