"""L04 on the real engine: what its runs repeat, and what its modules refuse."""

import numpy as np
import pytest
from lessons.engine_scenes import arrays, robot_in_scene

from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.sim.arm.batch import run_batch
from robo_genesis.sim.arm.franka import LINK_PARENTS

pytestmark = pytest.mark.engine


def test_a_case_repeats_to_the_last_bit_whatever_ran_before(lab, run):
    first = {name: run(spec.CASES[name]) for name in ("G1", "G2")}
    dofs = lab.joints.dofs
    lab.franka.set_dofs_kp(spec.BASELINE.kp * 3, dofs)
    lab.franka.set_dofs_force_range(np.full(9, -50.0), np.full(9, 60.0), dofs)
    lab.franka.control_dofs_velocity(np.full(7, 0.5), dofs[:7])
    for _ in range(10):
        lab.scene.step()
    for name in ("G2", "G1"):
        assert arrays(run(spec.CASES[name])) == arrays(first[name]), name


def test_the_parents_of_links_are_those_of_the_engine(lab):
    parents = [link.parent_idx - lab.franka.links[0].idx for link in lab.franka.links]
    assert (-1, *parents[1:]) == LINK_PARENTS


def test_a_batch_repeats(lab):
    few = study_spec.COMPARED
    scene = robot_in_scene(lab.gs, 3, batch_dofs_info=True, enable_self_collision=False)
    batch = vars(scene).values()
    first, again = (run_batch(*batch, few) for _ in "ab")
    assert all(arrays(first[name]) == arrays(again[name]) for name in few)
