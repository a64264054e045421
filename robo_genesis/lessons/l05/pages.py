"""The measuring pages of L05, and its declaration."""

from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES
from robo_genesis.sim.camera import record as view_record

from . import checks, spec, study
from .metrics import ReachMetrics, reach_metrics

MEASURES = False


MODEL = {"model": counts(spec.EXPECTED_MODEL)}
SEEN = {view_record.SEGMENTS: counts(spec.SEGMENTS)}

MOTION = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings=MODEL | study.READINGS,
    measure=reach_metrics,
    checks=checks.WITHOUT_CAMERA,
    parameters=spec.parameters,
    camera=False,
)
RECORDED = replace(
    MOTION,
    readings=MODEL | study.READINGS | SEEN | view_record.groups(spec.VIEWED),
    checks=checks.CHECKS,
    camera=True,
    frames=("initial", "final", *view_record.frame_names(spec.VIEWED)),
)
LECTURE = replace(
    RECORDED,
    runs={**RECORDED.runs, **runs_of(spec.MORE)},
    checks=checks.LECTURE,
    parameters=spec.lecture_parameters,
)
LAB = with_functions(RECORDED, "chain", "damped", "accept", "project", "back_project")

ANSWERS = runs_of(
    spec.QUESTIONS,
    measured=False,
    note="answers of the solver assigned to the state, no step taken; its time is nominal",
)

# The page about many solutions, the map of targets and the target beyond reach.
SOLUTIONS = MOTION.with_more(spec.solution_parameters, ANSWERS, checks=checks.SOLUTIONS)

BASELINE = replace(MOTION, runs=runs_of({"baseline": spec.BASELINE}))

# The page that computes Jacobians by hand.
JACOBIAN = replace(
    BASELINE,
    readings=MODEL | {study.JACOBIANS: Readings(dict.fromkeys(study.POSTURES, "m"))},
    checks=checks.JACOBIAN,
)

# The page about cameras; each view has colours, depth and segmentation.
CAMERAS = replace(
    BASELINE,
    readings=MODEL | SEEN | view_record.groups(*spec.VIEWS),
    checks=checks.CAMERAS,
    parameters=spec.view_parameters,
    camera=True,
    frames=view_record.frame_names(*spec.VIEWS),
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, ReachMetrics),
    pages={
        "lab": LAB,
        "lecture": LECTURE,
        "mistakes": replace(MOTION, camera=True, frames=()),
        "jacobian": JACOBIAN,
        "solutions": SOLUTIONS,
        "cameras": CAMERAS,
    },
    replays={
        "reach": Replay(
            tuple(spec.CASES)[:3],
            follows="joint4",
            thing="robot",
            goal=lambda case, state: spec.TARGET,
            credit=CREDIT,
            view="The robot in the posture of the sample; a sphere marks the target of the hand.",
            quality="The hand starts {start_distance} from its target and ends {final_distance} "
            "and {final_angle} from it.",
            filmed="the Franka",
        )
    },
)
