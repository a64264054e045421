"""The measuring pages of L02, and its declaration."""

from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.core.trace import BodyTrace

from . import checks, life_cycle, spec, trials
from .metrics import DropMetrics, drop_metrics

MEASURES = False


DROP = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings={"model": counts(spec.EXPECTED_MODEL), "body": Readings({"mass": "kg"})},
    measure=drop_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LAB = with_functions(DROP, "make_scene", "record", "usable_frame", "stepped")
LECTURE = replace(
    DROP,
    runs=runs_of(spec.CASES | spec.SUBSTEP_CASES),
    readings={
        **DROP.readings,
        life_cycle.GROUP: counts(life_cycle.expected(rendered=False)),
        **trials.READINGS,
    },
    with_camera={life_cycle.GROUP: counts(life_cycle.expected(rendered=True))},
    checks=(*checks.CHECKS, *checks.BY_STEP, life_cycle.sides_of_build, *trials.CHECKS),
    parameters=spec.study_parameters,
    frames=(*DROP.frames, spec.TRAYS),
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, DropMetrics),
    pages={"lab": LAB, "lecture": LECTURE, "mistakes": DROP},
    replays={
        "fall": Replay(tuple(spec.CASES), follows=spec.LINK, thing="box"),
        "steps": Replay(("baseline", "substeps_10"), follows=spec.LINK, thing="box"),
    },
)
