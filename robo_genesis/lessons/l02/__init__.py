"""L02: scenes, entities, and the simulation life cycle."""

from robo_genesis.lessons.declaration import COMMON_MODULES, Filmed, Lesson, MeasuringPage, Moving
from robo_genesis.lessons.l02 import recompute, spec
from robo_genesis.lessons.l02.metrics import DropMetrics

MODULES = (
    *COMMON_MODULES, "core.free_fall", "sim.rigid_bodies",
    "lessons.l02.checks", "lessons.l02.metrics",
)  # fmt: skip
STUDY_MODULES = ("lessons.l02.life_cycle", "lessons.l02.study")

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, DropMetrics),
    pages={
        "lab": MeasuringPage(spec.parameters, MODULES),
        spec.STUDY_PAGE: MeasuringPage(spec.study_parameters, MODULES + STUDY_MODULES),
    },
    recompute=recompute.recompute,
    filmed=Filmed("the box"),
    compared=Moving(tuple(spec.CASES), link=spec.LINK, thing="box"),
)
