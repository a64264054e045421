"""The measuring pages of L04, and its declaration."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.checks import Finding
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.experiment import (
    Experiment,
    MeasuringPage,
    Readings,
    Run,
    counts,
    runs_of,
)
from robo_genesis.core.text import listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import (
    checks,
    lecture_checks,
    spec,
    study,
    study_checks,
    study_spec,
)
from robo_genesis.lessons.l04.metrics import SETTLING_BAND, StepMetrics
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES

MEASURES = False


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the engine's counts of the robot."""
    return {"model": counts(spec.EXPECTED_MODEL)}


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=Trace,
    joints=JOINT_NAMES,
    readings=readings,
    measure=study.measure,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
MISTAKES = replace(LAB, checks=checks.WITHOUT_CAMERA, camera=False)


def with_runs(
    page: MeasuringPage,
    name: str,
    runs: Mapping[str, Run],
    units: Mapping[str, str],
    own: Sequence[Callable[[Experiment], Iterable[Finding]]],
) -> MeasuringPage:
    """Return a page with runs, readings and checks beside those of the given one."""
    of_joint = {study.GROUP: Readings(units)} if units else {}
    return replace(
        page,
        runs={**page.runs, **runs},
        readings=lambda rendered: readings(rendered) | of_joint,
        checks=(*page.checks, *own),
        parameters=lambda: spec.parameters() | study_spec.parameters(name),
    )


ASSIGNED = Run(
    spec.BASELINE,
    measured=False,
    note="state overwritten at each sample, no step taken; its time is nominal",
)
LECTURE = with_runs(
    LAB,
    "lecture",
    {
        **runs_of(study_spec.EXAMPLE_CASES | study_spec.LONGER_CASES),
        study_spec.ASSIGNED: ASSIGNED,
    },
    study.GRAVITY,
    (study_checks.study_factors, *lecture_checks.LECTURE),
)
FORMULA = with_runs(
    MISTAKES,
    "formula",
    # A run that holds its start has no step, so it has no metrics.
    {n: Run(case, not n.endswith("_hold")) for n, case in study_spec.STEP_CASES.items()},
    study.AT_START | study.MASSES | study.GRAVITY,
    study_checks.FORMULA,
)
IN_MUJOCO = {
    name: Run(spec.CASES[second.case], note="run in MuJoCo, not in Genesis")
    for name, second in study_spec.SECOND_RUNS.items()
}
INTEGRATOR = with_runs(
    MISTAKES,
    "integrator",
    runs_of(study_spec.SUBSTEP_CASES) | IN_MUJOCO,
    study.AT_START | study.IN_MUJOCO,
    study_checks.INTEGRATOR,
)
GRID_NOTE = "in a scene with a copy of the robot for each run of the grid"
BATCH = with_runs(
    MISTAKES,
    "batch",
    {name: Run(case, note=GRID_NOTE) for name, case in study_spec.GRID_CASES.items()},
    {},
    study_checks.GRID_CHECKS,
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, StepMetrics),
    pages={
        "lab": LAB,
        "lecture": LECTURE,
        "formula": FORMULA,
        "integrator": INTEGRATOR,
        "batch": BATCH,
        "mistakes": MISTAKES,
    },
    replays={
        "steps": Replay(
            tuple(study_spec.COMPARED),
            follows=spec.STEPPED_JOINT,
            thing="robot",
            band=SETTLING_BAND,
            until=0.6,
            credit=CREDIT,
            view="The robot in 3D, in the posture of the sample that is shown. "
            f"{spec.STEPPED_JOINT} moves.",
            alt=f"Position of {spec.STEPPED_JOINT} over time with the gains of "
            f"{listed(tuple(study_spec.COMPARED))}, its target and the settling band around it.",
            caption=f"Position of {spec.STEPPED_JOINT}, three settings of its controller, from "
            "get_dofs_position.",
            quality="Rise time {rise_time}, overshoot {overshoot}, final error {final_error}; at "
            "the force limit: {saturation_samples}.",
            filmed="the Franka",
        )
    },
)
