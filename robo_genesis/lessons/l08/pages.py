"""The measuring pages of L08, and its declaration."""

from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Run, counts, runs_of
from robo_genesis.core.trace import Demonstrations, Episodes, Trace
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES, MODEL_COUNTS
from robo_genesis.sim.camera import film
from robo_genesis.sim.common_checks import structure

from . import capstone, checks, metrics, rates, rates_checks, spec
from .capstone_checks import CAPSTONE
from .creep import HeldMetrics
from .creep_checks import CREEP
from .metrics import EpisodesMetrics

MEASURES = False


COPY = "repeats the episodes of another run of this page, and has no metrics"
SINGLE = (False, "one episode of a batch, at all its steps", Trace)

LECTURE = MeasuringPage(
    runs=runs_of(spec.EPISODES, *SINGLE)
    | runs_of(spec.CASES)
    | runs_of(spec.COPIES, measured=False, note=COPY),
    kind=Episodes,
    joints=JOINT_NAMES,
    readings={"model": counts(MODEL_COUNTS)},
    measure=metrics.episodes_metrics,
    checks=(*checks.CHECKS, *checks.LECTURE),
    parameters=spec.parameters,
)

# The frames that hold the films
SHEETS = [
    sheet
    for name in spec.FILMS
    for sheet in film.sheet_names(name, spec.EXACT.steps + 1)
]

LAB = with_functions(
    replace(
        LECTURE,
        runs=runs_of(spec.LAB_EPISODE, *SINGLE)
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
    runs=runs_of(rates.CASES),
    checks=rates_checks.RATES,
    parameters=rates.parameters,
    camera=False,
)
MISTAKES = replace(RATES, runs={}, checks=(structure,))

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
    metrics=dict.fromkeys(spec.CASES | rates.CASES, EpisodesMetrics)
    | dict.fromkeys(CREEP.cases, HeldMetrics)
    | dict.fromkeys(capstone.CASES, capstone.AttemptMetrics),
    pages={
        "lecture": LECTURE,
        "lab": LAB,
        "mistakes": MISTAKES,
        "rates": RATES,
        "creep": CREEP,
        "capstone": CAPSTONE,
    },
    replays={"episodes": EPISODES, "together": TOGETHER},
)
