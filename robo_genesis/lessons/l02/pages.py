"""The measuring pages of L02, and its declaration."""

from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import checks, life_cycle, spec, study, trials
from robo_genesis.lessons.l02.metrics import DropMetrics, drop_metrics

MEASURES = False


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the engine's values of the scene and the box."""
    return {"model": counts(spec.EXPECTED_MODEL), "body": Readings({"mass": "kg"})}


def study_readings(rendered: bool) -> dict[str, Readings]:
    """Return those of the lecture, which also tries each call on both sides of build."""
    tried = {life_cycle.GROUP: counts(life_cycle.expected(rendered))}
    return readings(rendered) | tried | trials.readings()


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings=readings,
    measure=drop_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LECTURE = replace(
    LAB,
    runs=runs_of(spec.CASES | spec.SUBSTEP_CASES),
    readings=study_readings,
    checks=(*checks.CHECKS, *study.CHECKS, life_cycle.sides_of_build, *trials.CHECKS),
    parameters=spec.study_parameters,
    frames=(*LAB.frames, spec.TRAYS),
)
MISTAKES = replace(LAB)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, DropMetrics),
    pages={"lab": LAB, "lecture": LECTURE, "mistakes": MISTAKES},
    replays={"fall": Replay(tuple(spec.CASES), follows=spec.LINK, thing="box")},
)
