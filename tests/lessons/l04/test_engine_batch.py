"""A batch of environments on the real engine: each of them does what its case does alone."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.lessons.l04 import batch as sweep
from robo_genesis.lessons.l04 import spec, study_checks, study_spec
from robo_genesis.lessons.l04.claims_text import GRID_CLAIMS
from robo_genesis.sim.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.joint_control import CaseError, run_case
from robo_genesis.sim.joints import resolve_joints

pytestmark = pytest.mark.engine

SMALL = study_spec.GridPoint(0.02, 3500.0, 300.0)
POINTS = (SMALL, *study_spec.CASE_POINTS.values())


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
    scene.build(n_envs=len(POINTS))
    return scene, robot, resolve_joints(robot, JOINT_NAMES)


@pytest.fixture(scope="module")
def found(batch):
    return sweep.sweep(*batch, POINTS)


def test_the_batch_gives_what_each_case_gives_alone(lab, found):
    alone = {
        name: run_case(lab.scene, lab.franka, lab.joints, spec.CASES[name])
        for name in study_spec.CASE_POINTS
    }
    run = study_checks.Grid(found, alone, lab.joints)
    outcomes = study_checks.run_grid_checks(run, GRID_CLAIMS)
    assert [check.detail for check in outcomes if not check.passed] == []
    small = run_case(lab.scene, lab.franka, lab.joints, SMALL.case)
    k = lab.joints.entry(spec.STEPPED_JOINT)
    assert np.abs(found.q[0] - small.q[:, k]).max() <= study_spec.AGREEMENT["rad"]


def test_environments_differ_as_their_cases_do(found):
    assert len({measured.overshoot for measured in found.metrics}) > 1
    assert np.ptp(found.q[:, -1]) > 0.2


def test_a_second_sweep_does_not_inherit_from_the_first(batch, found):
    again = sweep.sweep(*batch, POINTS)
    assert (again.q == found.q).all()
    assert (again.control_force == found.control_force).all()


def test_a_scene_of_another_size_is_refused(batch):
    with pytest.raises(CaseError, match="Build it with n_envs=3"):
        sweep.sweep(*batch, POINTS[:3])


def test_cases_of_unequal_length_are_refused(batch):
    cases = [point.case for point in POINTS]
    cases[0] = replace(cases[0], steps=10)
    with pytest.raises(CaseError, match="cases of equal length"):
        sweep.run_batch(*batch, cases)
