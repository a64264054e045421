"""The measuring pages of L09, and its declaration."""

from dataclasses import replace
from functools import partial

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import (
    MeasuringPage,
    Readings,
    Run,
    counts,
    runs_of,
)
from robo_genesis.core.trace import Demonstrations, Trace
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES, MODEL_COUNTS
from robo_genesis.sim.common_checks import structure

from . import checks, spec
from .metrics import Copies, CopiesMetrics, copies_metrics

MEASURES = False

ONE = (False, "one episode of a batch", Trace)


LECTURE = MeasuringPage(
    runs=runs_of(spec.EPISODES, *ONE) | runs_of(spec.CASES),
    kind=Copies,
    joints=JOINT_NAMES,
    readings={
        "model": counts(MODEL_COUNTS),
        "experts": counts(("waiting", "prompt", "delayed", "tried")),
    },
    measure=copies_metrics,
    checks=checks.LECTURE,
    parameters=partial(spec.parameters, spec.CASES, spec.EPISODES),
    camera=False,
)
ASKING = replace(
    LECTURE,
    runs=runs_of(spec.ASKED_EPISODES, *ONE) | runs_of(spec.ANSWERS),
    readings={
        "model": counts(MODEL_COUNTS),
        "experts": counts(("looking",)),
        "postures": Readings({"joints": "rad", "hand": "m"}),
    },
    checks=checks.ASKING,
    parameters=partial(spec.parameters, spec.ANSWERS, spec.ASKED_EPISODES),
)
INPUTS = replace(
    LECTURE,
    runs=runs_of(spec.CHANGED),
    readings={
        "model": counts(MODEL_COUNTS),
        "experts": counts(("prompt", "prompt_noisy")),
    },
    checks=checks.INPUTS,
    parameters=partial(spec.parameters, spec.CHANGED),
)
LAB = with_functions(
    replace(
        LECTURE,
        runs=runs_of(spec.LAB_EPISODE, *ONE)
        | {"shown": Run(spec.DEMONSTRATED, False, kind=Demonstrations)}
        | runs_of(spec.LAB),
        readings={"model": counts(MODEL_COUNTS), "experts": counts(("looking",))},
        checks=checks.LAB,
        parameters=partial(spec.parameters, spec.LAB, spec.LAB_EPISODE),
        camera=True,
    ),
    "pairs",
    "scale",
    "command",
    "rate",
    "aggregate",
)
MISTAKES = replace(
    LECTURE,
    runs={},
    readings={"model": counts(MODEL_COUNTS)},
    checks=(structure,),
    parameters=partial(spec.parameters, {}),
)

EPISODES = Replay(
    tuple(spec.EPISODES),
    follows="object",
    thing="object",
    credit=CREDIT,
    view="A robot picks up an object and places it in a bowl, or fails.",
    filmed="the first episode",
)
ASKED = replace(EPISODES, cases=tuple(spec.ASKED_EPISODES))

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(
        spec.CASES | spec.ANSWERS | spec.CHANGED | spec.LAB, CopiesMetrics
    ),
    pages={
        "lecture": LECTURE,
        "lab": LAB,
        "mistakes": MISTAKES,
        "asking": ASKING,
        "inputs": INPUTS,
    },
    replays={"episodes": EPISODES, "asked": ASKED},
)
