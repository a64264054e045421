"""The measuring pages of L01, and its declaration."""

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, counts, runs_of
from robo_genesis.core.trace import BodyTrace

from . import checks, machine, spec
from .metrics import FallMetrics, fall_metrics

MEASURES = False


FALL = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings={"model": counts(spec.EXPECTED_MODEL)},
    measure=fall_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LAB = with_functions(FALL, "height_after", "fall")
LECTURE = FALL.with_more(readings=machine.READINGS, checks=(checks.doctor,))

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, FallMetrics),
    pages={"lab": LAB, "lecture": LECTURE},
    replays={"fall": Replay(tuple(spec.CASES), follows=spec.LINK, thing="sphere")},
)
