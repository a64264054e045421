"""L05, forward and inverse kinematics, and cameras as sensors."""

from dataclasses import replace

from robo_genesis.core.scene import CAMERA, DT, SUBSTEPS
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.declaration import Filmed, Lesson
from robo_genesis.lessons.experiment import MeasuringPage, Readings, Run, counts, runs_of
from robo_genesis.lessons.l05 import (
    checks,
    claims_text,
    exercises,
    plausibility,
    spec,
    study,
)
from robo_genesis.lessons.l05.metrics import ReachMetrics
from robo_genesis.lessons.l05.run import ask, control_case, reach, solve_all
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.joints import resolve_joints

__all__ = [
    "CAMERA", "DT", "FRANKA_MJCF", "JOINT_NAMES", "LAB", "LESSON", "SOLUTIONS", "SUBSTEPS", "ask",
    "control_case", "exercises", "kinematics", "reach", "resolve_joints", "solve_all", "spec",
    "study",
]  # fmt: skip


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the engine's counts of the robot, and what it reports of the baseline's question."""
    return {
        "model": counts(spec.EXPECTED_MODEL),
        study.GROUP: Readings(study.IK_READINGS),
        study.REPEAT_GROUP: counts(study.REPEATED),
    }


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings=readings,
    measure=study.measure,
    checks=checks.LAB,
    claims=claims_text.CLAIMS,
    parameters=spec.parameters,
    validate=plausibility.require_possible_runs,
)

ANSWERS_NOTE = "answers of the solver assigned to the state, no step taken; its time is nominal"
SOLUTIONS = replace(
    LAB,
    runs={
        **runs_of(spec.CASES),
        **{name: Run(case, False, ANSWERS_NOTE) for name, case in spec.QUESTIONS.items()},
    },
    checks=(*(check for check in checks.LAB if check is not checks.posture), *checks.SOLUTIONS),
    parameters=lambda: spec.parameters() | {"questions": spec.case_parameters(spec.QUESTIONS)},
    camera=False,
)
"""The page about many solutions, the map of targets and the target beyond reach."""

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, ReachMetrics),
    pages={"lab": LAB, "solutions": SOLUTIONS},
    filmed=Filmed("the Franka"),
    marks=spec.CASE_MARKS,
)
