"""L05, forward and inverse kinematics, and cameras as sensors."""

from dataclasses import replace
from typing import TYPE_CHECKING

from robo_genesis.core.scene import CAMERA, DT, SUBSTEPS
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.declaration import Filmed, Lesson, on_demand
from robo_genesis.lessons.experiment import MeasuringPage, Readings, Run, counts, runs_of
from robo_genesis.lessons.l05 import (
    camera_spec,
    checks,
    claims_text,
    exercises,
    explorer,
    mistakes,
    plausibility,
    solutions_text,
    spec,
    study,
    study_views,
    view_record,
)
from robo_genesis.lessons.l05.metrics import ReachMetrics
from robo_genesis.lessons.l05.run import ask, control_case, reach, solve_all
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.joint_control import reset
from robo_genesis.sim.joints import resolve_joints

if TYPE_CHECKING:
    from robo_genesis.lessons.l05 import solutions_plots

__all__ = [
    "CAMERA", "CAMERAS", "DT", "FRANKA_MJCF", "JOINT_NAMES", "LAB", "LESSON", "MISTAKES",
    "SOLUTIONS", "SUBSTEPS", "ask", "camera_spec", "control_case", "exercises",
    "explorer", "kinematics", "mistakes", "reach", "reset", "resolve_joints", "solutions_plots",
    "solutions_text", "solve_all", "spec", "study", "study_views", "view_record",
]  # fmt: skip


__getattr__ = on_demand(__name__, "solutions_plots")

LINKS = (*(f"link{number}" for number in range(8)), "hand", "left_finger", "right_finger")


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
    checks=(*checks.WITHOUT_CAMERA, *checks.SOLUTIONS),
    parameters=lambda: spec.parameters() | {"questions": spec.case_parameters(spec.QUESTIONS)},
    camera=False,
)
"""The page about many solutions, the map of targets and the target beyond reach."""

MISTAKES = replace(LAB, checks=checks.WITHOUT_CAMERA, frames=())


def camera_readings(rendered: bool) -> dict[str, Readings]:
    """Return the groups of the page about cameras."""
    numbers = counts((study_views.PLANE, *LINKS, study_views.MARKER))
    segments = {study_views.SEGMENTS: numbers} if rendered else {}
    model = {"model": counts(spec.EXPECTED_MODEL)}
    return model | view_record.groups(*camera_spec.FOV) | segments


CAMERAS = replace(
    LAB,
    runs=runs_of({"baseline": spec.BASELINE}),
    readings=camera_readings,
    checks=study_views.CAMERAS,
    claims=study_views.CLAIMS,
    parameters=lambda: spec.parameters() | camera_spec.parameters(),
    frames=view_record.frame_names(*camera_spec.FOV),
)
"""The page about cameras; every view has colours, depth and segmentation."""

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, ReachMetrics),
    pages={"lab": LAB, "solutions": SOLUTIONS, "mistakes": MISTAKES, "cameras": CAMERAS},
    filmed=Filmed("the Franka"),
    marks=spec.CASE_MARKS,
)
