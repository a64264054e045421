"""A batch of environments on the real engine: each of them does what its case does alone."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.sim.arm.batch import run_batch
from robo_genesis.sim.arm.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.arm.joint_control import CaseError, run_case
from robo_genesis.sim.arm.joints import resolve_joints

pytestmark = pytest.mark.engine

SMALL = study_spec.GridPoint(0.02, 3500.0, 300.0)
CASES = {"small": SMALL.case, **study_spec.COMPARED}


@pytest.fixture(scope="module")
def batch(lab):
    """The batched scene as the lecture builds it, with its robot and map."""
    scene = lab.gs.Scene(
        sim_options=lab.gs.options.SimOptions(dt=DT, substeps=SUBSTEPS),
        rigid_options=lab.gs.options.RigidOptions(
            batch_dofs_info=True, enable_self_collision=False
        ),
        show_viewer=False,
    )
    scene.add_entity(lab.gs.morphs.Plane())
    robot = scene.add_entity(lab.gs.morphs.MJCF(file=FRANKA_MJCF))
    scene.build(n_envs=len(CASES))
    return scene, robot, resolve_joints(robot, JOINT_NAMES)


@pytest.fixture(scope="module")
def found(batch):
    return run_batch(*batch, CASES)


def test_the_batch_gives_what_each_case_gives_alone(lab, found):
    for name, case in CASES.items():
        alone = run_case(lab.scene, lab.franka, lab.joints, case)
        for array, unit in (("q", "rad"), ("qd", "rad/s"), ("control_force", "N·m")):
            apart = np.abs(getattr(found[name], array) - getattr(alone, array))[:, spec.ENTRY]
            assert apart.max() <= study_spec.AGREEMENT[unit], (name, array)


def test_environments_differ_as_their_cases_do(found):
    assert len({step_metrics(run, spec.ENTRY).overshoot for run in found.values()}) > 1
    assert np.ptp([run.q[-1, spec.ENTRY] for run in found.values()]) > 0.2


def test_a_second_batch_does_not_inherit_from_the_first(batch, found):
    again = run_batch(*batch, CASES)
    for name, run in found.items():
        assert (again[name].q == run.q).all()
        assert (again[name].control_force == run.control_force).all()


def test_a_scene_of_another_size_is_refused(batch):
    with pytest.raises(CaseError, match="Build it with n_envs=3"):
        run_batch(*batch, study_spec.COMPARED)


def test_cases_of_unequal_length_are_refused(batch):
    cases = CASES | {"small": replace(SMALL.case, steps=10)}
    with pytest.raises(CaseError, match="cases of equal length"):
        run_batch(*batch, cases)
