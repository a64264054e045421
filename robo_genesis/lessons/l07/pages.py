"""The measuring pages of L07, and its declaration."""

from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, counts, runs_of
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l07 import checks, rest, spec
from robo_genesis.lessons.l07.metrics import TurnMetrics, turn_metrics
from robo_genesis.lessons.l07.rest_checks import REST
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES, MODEL_COUNTS

MEASURES = False

TURN = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings={"model": counts(MODEL_COUNTS)},
    measure=turn_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
    camera=False,
)

LAB = with_functions(TURN, "law")
MISTAKES = replace(TURN, runs={}, checks=(checks.structure,))

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, TurnMetrics) | dict.fromkeys(rest.CASES, rest.RestMetrics),
    pages={"lecture": TURN, "lab": LAB, "mistakes": MISTAKES, "rest": REST},
    replays={
        "turn": Replay(
            tuple(spec.CASES),
            follows=spec.JOINT,
            thing="robot",
            band=0.01,
            credit=CREDIT,
            quality="The joint ends {final_error} from its target.",
        )
    },
)
