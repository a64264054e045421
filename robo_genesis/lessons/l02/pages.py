"""The measuring pages of L02, and its declaration."""

from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import checks, life_cycle, spec, study, trials
from robo_genesis.lessons.l02.metrics import DropMetrics, drop_metrics

MEASURES = False


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings={"model": counts(spec.EXPECTED_MODEL), "body": Readings({"mass": "kg"})},
    measure=drop_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LECTURE = replace(
    LAB,
    runs=runs_of(spec.CASES | spec.SUBSTEP_CASES),
    readings={
        **LAB.readings,
        life_cycle.GROUP: counts(life_cycle.expected(rendered=False)),
        **trials.READINGS,
    },
    with_camera={life_cycle.GROUP: counts(life_cycle.expected(rendered=True))},
    checks=(*checks.CHECKS, *study.CHECKS, life_cycle.sides_of_build, *trials.CHECKS),
    parameters=spec.study_parameters,
    frames=(*LAB.frames, spec.TRAYS),
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, DropMetrics),
    pages={"lab": LAB, "lecture": LECTURE, "mistakes": LAB},
    replays={"fall": Replay(tuple(spec.CASES), follows=spec.LINK, thing="box")},
)
