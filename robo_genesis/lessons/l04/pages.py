"""The measuring pages of L04, and its declaration."""

from dataclasses import replace
from functools import partial

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Readings, Run, counts, runs_of
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES

from . import checks, spec, study, study_checks, study_spec
from .metrics import SETTLING_BAND, StepMetrics

MEASURES = False


STEPS = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings={"model": counts(spec.EXPECTED_MODEL)},
    measure=study.measure,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LAB = with_functions(STEPS, "resolve", "record", "pd_effort", "measure")
MISTAKES = replace(STEPS, checks=checks.WITHOUT_CAMERA, camera=False)


ASSIGNED = Run(
    study_spec.INDEX_CASES["P1"],
    measured=False,
    note="state overwritten at each sample, no step taken; its time is nominal",
)
LECTURE = replace(
    STEPS,
    runs=runs_of(study_spec.INDEX_CASES, measured=False)
    | {study_spec.ASSIGNED: ASSIGNED},
    checks=checks.LECTURE,
).with_more(partial(study_spec.parameters, "lecture"))
MOTION = MISTAKES.with_more(
    partial(study_spec.parameters, "motion"),
    runs_of(study_spec.EXAMPLE_CASES | study_spec.LONGER_CASES),
    {study.GROUP: Readings(study.GRAVITY)},
    (study_checks.study_factors, study_checks.same_model, *checks.MOTION),
)
FORMULA = MISTAKES.with_more(
    partial(study_spec.parameters, "formula"),
    # A run that holds its start has no step, so it has no metrics.
    {
        n: Run(case, not n.endswith("_hold"))
        for n, case in study_spec.STEP_CASES.items()
    },
    {study.GROUP: Readings(study.AT_START | study.MASSES | study.GRAVITY)},
    study_checks.FORMULA,
)
FORMULA = with_functions(FORMULA, "stepped")
IN_MUJOCO = {
    name: Run(spec.CASES[second.case], note="run in MuJoCo, not in Genesis")
    for name, second in study_spec.SECOND_RUNS.items()
}
INTEGRATOR = MISTAKES.with_more(
    partial(study_spec.parameters, "integrator"),
    runs_of(study_spec.SUBSTEP_CASES) | IN_MUJOCO,
    {study.GROUP: Readings(study.AT_START)},
    study_checks.INTEGRATOR,
)
BATCH = MISTAKES.with_more(
    partial(study_spec.parameters, "batch"),
    runs_of(
        study_spec.GRID_CASES,
        note="in a scene with a copy of the robot for each run of the grid",
    ),
    checks=(study_checks.grid_matches_cases,),
)

GAINS = Replay(
    tuple(study_spec.COMPARED),
    follows=spec.STEPPED_JOINT,
    thing="robot",
    band=SETTLING_BAND,
    until=0.6,
    credit=CREDIT,
    quality="Rise time {rise_time}, overshoot {overshoot}, final error {final_error}; at the force "
    "limit: {saturation_samples}.",
    filmed="the Franka",
)
# The question is about P2.
NAMES = replace(GAINS, cases=("P2", "P1"), band=0, quality="")

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, StepMetrics),
    pages={
        "lab": LAB,
        "lecture": LECTURE,
        "motion": MOTION,
        "formula": FORMULA,
        "integrator": INTEGRATOR,
        "batch": BATCH,
        "mistakes": MISTAKES,
    },
    replays={
        "gains": GAINS,
        "steps": replace(GAINS, cases=("G1", "G2")),
        "baseline": replace(GAINS, cases=("baseline",)),
        "names": NAMES,
        "assigned": replace(
            NAMES, cases=(study_spec.ASSIGNED, "P1"), follows="hand", until=None
        ),
    },
)
