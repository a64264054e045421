"""L04, robot models, degrees of freedom, and joint control."""

from dataclasses import replace
from typing import TYPE_CHECKING

from robo_genesis.core.channels import View
from robo_genesis.core.scene import CAMERA, DT, SUBSTEPS
from robo_genesis.core.text import listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.declaration import Compared, Filmed, Lesson, on_demand
from robo_genesis.lessons.experiment import MeasuringPage, Readings, Run, counts, runs_of
from robo_genesis.lessons.l04 import (
    backend_mistake,
    checks,
    claims_text,
    engine_comparison,
    explorer,
    lecture_text,
    mistakes,
    plausibility,
    spec,
    study,
    study_checks,
    study_spec,
    text,
    theory_text,
)
from robo_genesis.lessons.l04.batch import run_batch
from robo_genesis.lessons.l04.metrics import SETTLING_BAND, StepMetrics
from robo_genesis.sim import mujoco_joints
from robo_genesis.sim.film import FilmedScene
from robo_genesis.sim.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.joint_control import (
    assign_path,
    differences,
    reset,
    run_case,
    validate,
)
from robo_genesis.sim.joints import resolve_joints
from robo_genesis.sim.visual_shape import read_shape

if TYPE_CHECKING:
    from robo_genesis.lessons.l04 import plots, study_plots

__all__ = [
    "CAMERA", "DT", "FRANKA_MJCF", "JOINT_NAMES", "LAB", "LECTURE", "LESSON", "SUBSTEPS",
    "FilmedScene", "assign_path", "backend_mistake", "differences", "engine_comparison", "explorer",
    "lecture_text", "mistakes", "mujoco_joints", "plots", "read_shape", "reset", "resolve_joints",
    "run_batch", "run_case", "spec", "study", "study_plots", "study_spec", "text", "theory_text",
    "validate",
]  # fmt: skip

__getattr__ = on_demand(__name__, "plots", "study_plots")


STUDY_RUNS = {
    # A run that holds its start has no step, so it has no metrics.
    **{n: Run(case, not n.endswith("_hold")) for n, case in study_spec.STEP_CASES.items()},
    **runs_of(study_spec.LONGER_CASES),
    **runs_of(study_spec.SUBSTEP_CASES),
    **{
        name: Run(spec.CASES[second.case], note="run in MuJoCo, not in Genesis")
        for name, second in study_spec.SECOND_RUNS.items()
    },
    study_spec.ASSIGNED: Run(
        spec.BASELINE,
        measured=False,
        note="state overwritten at each sample, no step taken; its time is nominal",
    ),
    **{
        name: Run(case, note="in a scene with a copy of the robot for each run of the grid")
        for name, case in study_spec.GRID_CASES.items()
    },
}


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the engine's counts of the robot."""
    return {"model": counts(spec.EXPECTED_MODEL)}


def study_readings(rendered: bool) -> dict[str, Readings]:
    """Return those of the lecture, which also reads what theory needs of the stepped joint."""
    return readings(rendered) | {study.GROUP: Readings(study.UNITS)}


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings=readings,
    measure=study.measure,
    checks=checks.CHECKS,
    claims=claims_text.CLAIMS,
    parameters=spec.parameters,
    validate=plausibility.require_possible_runs,
)
LECTURE = replace(
    LAB,
    runs=runs_of(spec.CASES) | STUDY_RUNS,
    readings=study_readings,
    checks=(*checks.CHECKS, *study_checks.CHECKS),
    parameters=lambda: spec.parameters() | study_spec.parameters(),
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, StepMetrics),
    pages={"lab": LAB, study_spec.PAGE: LECTURE},
    filmed=Filmed("the Franka"),
    marks=spec.CASE_MARKS,
    compared=Compared(
        tuple(study_spec.COMPARED),
        joint=spec.STEPPED_JOINT,
        band=SETTLING_BAND,
        until=0.6,
        view=View(
            thing="robot",
            alt="The robot in 3D, in the posture of the sample that is shown. "
            f"{spec.STEPPED_JOINT} moves.",
            credit="Franka Emika Panda model of MuJoCo Menagerie, Apache-2.0, from "
            "franka_description, © Franka Robotics GmbH; decimated and converted",
            orbit="45deg 72deg 90%",
            target="0.2m 0.52m 0m",
        ),
        alt=f"Position of {spec.STEPPED_JOINT} over time with the gains of "
        f"{listed(tuple(study_spec.COMPARED))}, its target and the settling band around it.",
        caption=f"Position of {spec.STEPPED_JOINT}, three settings of its controller, from "
        "get_dofs_position.",
        quality="Rise time {rise_time}, overshoot {overshoot}, final error {final_error}; at the "
        "force limit: {saturation_samples}.",
    ),
)
