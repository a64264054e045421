from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l04 import spec
from robo_genesis.sim.arm.laws import driven_in_mujoco, last_step
from robo_genesis.sim.mujoco import joints as mujoco_joints
from robo_genesis.sim.mujoco.kinematics import link_poses

LINKS, HOW = ("link7", "hand"), (0.01, "Euler")
CASE = spec.G2
RUN = mujoco_joints.run_case(CASE, LINKS, *HOW)


def rounded_otherwise(of):
    """The case on another CPU: a gain differs by the last bits of float64."""
    return replace(of, kv=np.asarray(of.kv) * (1 + 1e-15))


def codes(trace):
    return [breach.code for breach in driven_in_mujoco(trace, CASE, LINKS, *HOW)]


def test_a_run_that_amplifies_rounding_is_sound():
    other = mujoco_joints.run_case(rounded_otherwise(CASE), LINKS, *HOW)
    assert np.abs(other.qd - RUN.qd).max() > 1e-2
    assert codes(RUN) == codes(other) == []


CODES = [
    ("q", "start"),
    ("qd", "law"),
    ("internal_force", "motion"),
    ("target", "start"),
]


@pytest.mark.parametrize(("array", "code"), CODES)
def test_an_altered_array_is_a_breach(array, code):
    altered = replace(RUN, **{array: getattr(RUN, array) * 1.02})
    assert codes(altered)[0] == code


def test_a_run_by_another_integrator_is_a_breach():
    other = mujoco_joints.run_case(CASE, LINKS, HOW[0], "implicitfast")
    assert "motion" in codes(other)


def test_one_run_leaves_nothing_behind_that_changes_the_next():
    other = replace(CASE, kv=CASE.kv * 3, q_start=CASE.q_start + 0.1)
    before = [*link_poses(RUN.q, LINKS), *last_step(RUN, CASE, RUN.q[1:])]
    link_poses(RUN.q + 1, LINKS)
    last_step(RUN, other, RUN.q[1:] - 1)
    after = [*link_poses(RUN.q, LINKS), *last_step(RUN, CASE, RUN.q[1:])]
    assert all(np.array_equal(*pair) for pair in zip(before, after, strict=True))
