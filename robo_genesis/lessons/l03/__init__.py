"""L03: rigid-body physics and stable simulation."""

from robo_genesis.lessons.declaration import COMMON_MODULES, Filmed, Lesson, MeasuringPage, Moving
from robo_genesis.lessons.l03 import recompute, spec
from robo_genesis.lessons.l03.metrics import metrics_class

MODULES = (
    *COMMON_MODULES, "core.free_fall", "sim.contacts", "sim.rigid_bodies", "lessons.l03.checks",
    "lessons.l03.energy", "lessons.l03.friction", "lessons.l03.metrics",
)  # fmt: skip
STUDY_MODULES = ("lessons.l03.study", "sim.mujoco_contacts", "sim.visual_shape")

LESSON = Lesson(
    spec=spec,
    metrics={name: metrics_class(case) for name, case in spec.CASES.items()},
    pages={
        "lab": MeasuringPage(spec.parameters, MODULES),
        spec.STUDY_PAGE: MeasuringPage(
            spec.study_parameters, MODULES + STUDY_MODULES, cases=tuple(spec.REPEATED)
        ),
    },
    recompute=recompute.recompute,
    filmed=Filmed("the cube"),
    compared=Moving(("baseline", "dt10_sub1"), link=spec.LINK, thing="cube", until=0.5),
    further={"slides": Moving(tuple(spec.SLIDES), link=spec.LINK, thing="cube", axes=("x", "z"))},
)
