"""The measuring pages of L08, and its declaration."""

from dataclasses import replace
from typing import Any

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Run, counts
from robo_genesis.core.trace import Demonstrations, Episodes, Trace
from robo_genesis.lessons.l08 import checks, edge, edge_checks, metrics, spec
from robo_genesis.lessons.l08.creep import HeldMetrics
from robo_genesis.lessons.l08.creep_checks import CREEP
from robo_genesis.lessons.l08.metrics import EpisodesMetrics
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES, MODEL_COUNTS
from robo_genesis.sim.camera import film

MEASURES = False

COPY = "repeats the episodes of another run of this page, and has no metrics"
ONE = "one episode of a batch, at all its steps"


# The frames that hold the films
SHEETS = [
    of for name in spec.FILMS for of in film.sheet_names(name, spec.EXACT.steps + 1)
]


def batches(cases: dict[str, Any]) -> dict[str, Run]:
    """Return runs of all episodes; those that are not counted copy others."""
    counted = {name: name in (*spec.COUNTED, *edge.COUNTED) for name in cases}
    return {
        n: Run(cases[n], own, "" if own else COPY, Episodes)
        for n, own in counted.items()
    }


LECTURE = MeasuringPage(
    runs={name: Run(case, False, ONE) for name, case in spec.EPISODES.items()}
    | batches(spec.BATCHES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings={"model": counts(MODEL_COUNTS)},
    measure=metrics.episodes_metrics,
    checks=(*checks.CHECKS, *checks.LECTURE),
    parameters=spec.parameters,
)

LAB = with_functions(
    replace(
        LECTURE,
        runs={name: Run(case, False, ONE) for name, case in spec.LAB_EPISODE.items()}
        | batches(spec.LAB)
        | {"exact": Run(spec.EXACT, kind=Demonstrations)},
        checks=(*checks.CHECKS, *checks.LAB),
        parameters=spec.lab_parameters,
        frames=("initial", "final", *SHEETS),
    ),
    "grasp_pose",
    "ended",
    "rungs",
    "wilson",
    "creep",
)

RATES = replace(
    LECTURE,
    runs=batches(edge.COUNTED | edge.COPIES),
    checks=edge_checks.RATES,
    parameters=edge.parameters,
    camera=False,
)
MISTAKES = replace(RATES, runs={}, checks=(checks.structure,))

EPISODES = Replay(
    tuple(spec.SHOWN),
    follows="object",
    thing="object",
    credit=CREDIT,
    view="The robot picks the object and places it in the bowl.",
    filmed="the first episode",
)
TOGETHER = replace(
    EPISODES,
    places=spec.PLACES,
    repeats=True,
    view="Four robots pick their objects. One of them places its object in its bowl.",
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys((*spec.COUNTED, *edge.COUNTED), EpisodesMetrics)
    | dict.fromkeys(CREEP.cases, HeldMetrics),
    pages={
        "lecture": LECTURE,
        "lab": LAB,
        "mistakes": MISTAKES,
        "rates": RATES,
        "creep": CREEP,
    },
    replays={"episodes": EPISODES, "together": TOGETHER},
)
