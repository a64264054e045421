"""The measuring pages of L08, and its declaration."""

from typing import Any

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.experiment import MeasuringPage, Run, counts
from robo_genesis.core.trace import Episodes, Trace
from robo_genesis.lessons.l08 import checks, ladder, spec
from robo_genesis.lessons.l08.creep import HeldMetrics
from robo_genesis.lessons.l08.creep_checks import CREEP
from robo_genesis.lessons.l08.ladder import EpisodesMetrics
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES, MODEL_COUNTS

MEASURES = False

COPIES = {"again": "repeats another run of this page", "permuted": "has the episodes of another run"}
ONE = "one episode of a batch, at all its steps"


def batches(cases: dict[str, Any]) -> dict[str, Run]:
    """Return runs of all episodes; copies of others have no metrics."""
    return {
        name: Run(case, name not in COPIES, COPIES.get(name, ""), Episodes)
        for name, case in cases.items()
    }


LECTURE = MeasuringPage(
    runs=batches(spec.BATCHES)
    | {name: Run(case, False, ONE) for name, case in spec.EPISODES.items()},
    kind=Trace,
    joints=JOINT_NAMES,
    readings={"model": counts(MODEL_COUNTS)},
    measure=ladder.episodes_metrics,
    checks=(*checks.CHECKS, *checks.LECTURE),
    parameters=spec.parameters,
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(("exact", "askew"), EpisodesMetrics)
    | dict.fromkeys(CREEP.cases, HeldMetrics),
    pages={"lecture": LECTURE, "creep": CREEP},
    replays={
        "episodes": Replay(
            tuple(spec.SHOWN),
            follows="object",
            thing="object",
            credit=CREDIT,
            view="The robot picks the object and places it in the bowl.",
            filmed="the first episode",
        )
    },
)
