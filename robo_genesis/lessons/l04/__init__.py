"""L04, robot models, degrees of freedom, and joint control."""

from robo_genesis.core.palette import CASES
from robo_genesis.lessons.declaration import COMMON_MODULES, Compared, Filmed, Lesson, MeasuringPage
from robo_genesis.lessons.l04 import recompute, spec, study_spec
from robo_genesis.lessons.l04.metrics import SETTLING_BAND, StepMetrics

MODULES = (*COMMON_MODULES, "sim.joint_control", "lessons.l04.checks", "lessons.l04.metrics")
STUDY_MODULES = (
    "core.orderings", "lessons.l04.study", "lessons.l04.study_checks", "lessons.l04.theory",
    "sim.dynamics", "sim.mujoco_joints",
)  # fmt: skip

CASES.update(G1="first", G2="second", G3="third")

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, StepMetrics),
    pages={
        "lab": MeasuringPage(spec.parameters, MODULES),
        study_spec.PAGE: MeasuringPage(
            lambda: spec.parameters() | study_spec.parameters(), MODULES + STUDY_MODULES
        ),
    },
    recompute=recompute.recompute,
    filmed=Filmed("the Franka"),
    compared=Compared(
        tuple(study_spec.COMPARED), joint=spec.STEPPED_JOINT, band=SETTLING_BAND, until=0.6
    ),
)
