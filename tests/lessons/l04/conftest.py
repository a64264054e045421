"""The studies of L04 without Genesis."""

from dataclasses import replace

import pytest
from lessons.changed_runs import passed
from robot_runs import assigned, driven

from robo_genesis.core.exercises import FUNCTIONS, functions
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04 import study as studies
from robo_genesis.lessons.l04 import study_spec
from robo_genesis.lessons.l04.pages import LECTURE, LESSON, STEPS
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.mujoco import joints as mujoco_joints

LINKS = ("link0", "link4", "hand")


PAGES = {name: page for name, page in LESSON.pages.items() if name not in ("lab", "mistakes")}
"""The pages with runs beyond those of the lab."""


def own_checks():
    """Return each check of these pages that the lab does not have, once."""
    found = dict.fromkeys(check for page in PAGES.values() for check in page.checks)
    return tuple(check for check in found if check not in STEPS.checks and check is not functions)


def of_page(run: Experiment, name: str) -> Experiment:
    """Return what one page measured of all studies."""
    page, group = LESSON.pages[name], studies.GROUP
    kept = page.readings.get(group)
    readings = {"model": run.readings["model"]}
    if FUNCTIONS in page.readings:
        readings |= passed(page)
    if kept:
        readings[group] = {unit: run.readings[group][unit] for unit in kept.units}
    frames = run.frames if page.camera else {}
    traces = {n: run.traces[n] for n in page.runs}
    return replace(run, page=page, traces=traces, readings=readings, frames=frames,
                   rendered=page.camera)  # fmt: skip


@pytest.fixture(scope="session")
def study_runs(joints, frames) -> Experiment:
    """All runs of L04's lecture and deeper pages, which pass every check, without Genesis."""
    every = {n: run for page in PAGES.values() for n, run in page.runs.items()}
    page = replace(LECTURE, runs=every, checks=(*STEPS.checks, *own_checks()))
    cases = {n: run.case for n, run in every.items() if n not in study_spec.SECOND_RUNS}
    traces = {name: driven(case, LINKS) for name, case in cases.items()}
    for name, run in study_spec.SECOND_RUNS.items():
        case = l04.CASES[run.case]
        traces[name] = mujoco_joints.run_case(case, LINKS, run.timestep, run.integrator)
    traces[study_spec.ASSIGNED] = assigned(l04.BASELINE, LINKS, traces["baseline"])
    return Experiment(
        page=page,
        traces={name: traces[name] for name in every},
        links=LINKS,
        readings={"model": l04.EXPECTED_MODEL, studies.GROUP: studies.by_model(traces)},
        frames=frames,
        rendered=True,
        joints=joints,
    )


@pytest.fixture(scope="session")
def experiments(study_runs) -> dict[str, Experiment]:
    """What each of these pages measured."""
    return {name: of_page(study_runs, name) for name in PAGES}


@pytest.fixture(scope="module")
def run(lab):
    """Control cases on the lab's robot."""
    return lambda case: run_case(lab.scene, lab.franka, lab.joints, case)
