from dataclasses import replace

import numpy as np
import pytest
from robot_runs import assigned, driven

from robo_genesis.lessons.l04 import spec
from robo_genesis.sim.arm.laws import assigned_run, driven_run
from robo_genesis.sim.mujoco import joints as mujoco_joints
from robo_genesis.sim.mujoco.kinematics import link_poses

LINKS = ("link7", "hand")
CASE = spec.G2
RUN = driven(CASE, LINKS)


@pytest.mark.parametrize("further", [0, 2])
def test_driven_and_assigned_runs_keep_their_laws_beside_other_links(further):
    pos, quat = (
        np.concatenate([part, np.zeros_like(part[:, :further])], axis=1)
        for part in (RUN.link_pos, RUN.link_quat)
    )
    assert not [*driven_run(replace(RUN, link_pos=pos, link_quat=quat), CASE, LINKS)]
    assert not [*driven_run(mujoco_joints.run_case(CASE, LINKS, 0.01), CASE, LINKS)]
    assert not [*assigned_run(assigned(CASE, LINKS, RUN), LINKS, CASE.model)]


@pytest.mark.parametrize(
    "array",
    ["q", "qd", "control_force", "start_control_force", "link_pos", "link_quat"],
)
def test_another_control_law_or_other_kinematics_break_them(array):
    altered = replace(RUN, **{array: getattr(RUN, array) * 1.02})
    assert [*driven_run(altered, CASE, LINKS)]
    assert [*driven_run(RUN, replace(CASE, kv=CASE.kv * 1.01), LINKS)]


def test_an_assigned_run_has_the_assigned_positions():
    run = assigned(CASE, LINKS, RUN)
    assert [*assigned_run(replace(run, target=run.target + 1e-5), LINKS, CASE.model)]


def test_one_run_leaves_nothing_behind_that_changes_the_next():
    before = link_poses(RUN.q, LINKS)
    link_poses(RUN.q + 1, LINKS)
    for pair in zip(before, link_poses(RUN.q, LINKS), strict=True):
        assert np.array_equal(*pair)
