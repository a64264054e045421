"""Both parts of the lecture and the deeper pages of L04 without Genesis."""

import pytest
from lessons.experiments import experiment_of
from robot_runs import assigned, driven

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.pages import LESSON
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.mujoco import joints as mujoco_joints

LINKS = ("link0", "link4", "hand")
PAGES = {
    name: page for name, page in LESSON.pages.items() if name not in ("lab", "mistakes")
}
"""The pages with runs beyond those of the lab."""


@pytest.fixture(scope="session")
def experiments(joints, frames) -> dict[str, Experiment]:
    """What each of these pages measured in runs that pass every check."""
    cases = {name: case for page in PAGES.values() for name, case in page.cases.items()}
    second = study_spec.SECOND_RUNS
    traces = {n: driven(case, LINKS) for n, case in cases.items() if n not in second}
    for name, of in second.items():
        traces[name] = mujoco_joints.run_case(
            cases[name], LINKS, of.timestep, of.integrator
        )
    traces[study_spec.ASSIGNED] = assigned(
        study_spec.INDEX_CASES["P1"], LINKS, traces["P1"]
    )
    known = {"model": spec.EXPECTED_MODEL, study.GROUP: study.by_model(traces)}
    given = (traces, known, LINKS, frames, joints)
    return {name: experiment_of(page, *given) for name, page in PAGES.items()}


@pytest.fixture(scope="module")
def run(lab):
    """Control cases on the lab's robot."""
    return lambda case: run_case(lab.scene, lab.franka, lab.joints, case)
