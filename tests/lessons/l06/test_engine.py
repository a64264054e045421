"""Worlds in the real engine: rows, subsets, refusals."""

from types import SimpleNamespace

import numpy as np
import pytest
from lessons.engine_scenes import robot_in_scene

from robo_genesis.lessons.l06 import mistakes, spec, study
from robo_genesis.lessons.l06.run import ask, reach
from robo_genesis.sim.arm.batch import Batch, set_link_mass
from robo_genesis.sim.arm.joint_control import CaseError
from robo_genesis.sim.arm.joints import to_numpy

pytestmark = pytest.mark.engine

WORLDS = list(spec.WORLDS.values())
EACH = {"batch_dofs_info": True, "batch_links_info": True}


@pytest.fixture(scope="module")
def four(real_engine):
    return robot_in_scene(real_engine.gs, len(WORLDS), **EACH)


@pytest.fixture(scope="module")
def single(real_engine):
    return robot_in_scene(real_engine.gs, **EACH)


@pytest.fixture(scope="module")
def measured(four, single):
    """The runs of the lecture's environments, each alone too, and then those of other robots."""
    page = SimpleNamespace(traces={}, readings={}, joints=four.joints)
    page.capture = lambda camera, name: None
    study.record(page, four.scene, four.robot, None)
    study.record_alone(page, single.scene, single.robot)
    study.record_variants(page, four.scene, four.robot)
    return page.traces


def test_a_second_run_agrees_with_the_first_and_inherits_no_load(four, measured):
    for name, run in zip(spec.WORLDS, reach(**vars(four), worlds=WORLDS), strict=True):
        apart = study.largest_differences(run, measured[name])
        assert all(apart[array] <= most for array, most in spec.SAME_RUN.items()), apart


def test_answers_of_some_environments_are_those_of_all(four):
    every = ask(four.robot, four.joints, WORLDS)
    some = ask(four.robot, four.joints, [WORLDS[3], WORLDS[1]], envs=[3, 1])
    assert (some.q == every.q[[3, 1]]).all()
    assert (some.error == every.error[[3, 1]]).all()


@pytest.mark.parametrize(("rows", "envs", "message"), [
    (1, [1, 3], r"shape \(1, 9\), expected one row"),
    (4, [1, 3], r"shape \(4, 9\), expected one row"),
    (2, [1, 1], r"Environments \[1, 1\]"), (1, [4], r"Environments \[4\]"),
    (0, [], r"Environments \[\]"),
])  # fmt: skip
def test_a_command_that_would_broadcast_is_refused(four, rows, envs, message):
    cases = [world.commanding(world.q_start) for world in WORLDS]
    batch = Batch(**vars(four), cases=cases)
    with pytest.raises(CaseError, match=message):
        batch.command(np.tile(spec.FIRST.q_start, (rows, 1)), envs)


def test_a_mass_is_that_of_one_environment_and_survives_a_reset(four):
    set_link_mass(four.robot, "hand", [1.0], [1])
    four.scene.reset()
    assert set_link_mass(four.robot, "hand", [0.73], [2]) == pytest.approx([0.73, 1, 0.73, 0.73])
    assert set_link_mass(four.robot, "hand", [0.73], [1]) == pytest.approx([0.73] * 4)


@pytest.mark.parametrize(("size", "same"), [(1, "alone"), (2, "env"), (64, "env")])
def test_batches_have_equal_bits_and_one_environment_those_alone(real_engine, measured, size, same):
    worlds = [WORLDS[k % len(WORLDS)] for k in range(size)]
    runs = reach(**vars(robot_in_scene(real_engine.gs, size, **EACH)), worlds=worlds)
    pairs = [(run, measured[f"{same}_{k % len(WORLDS)}"]) for k, run in enumerate(runs)]
    assert {study.entries_that_differ(*pair)[0] for pair in pairs} == {0}


def test_without_its_option_a_scene_has_one_set_of_gains_whatever_environment_is_named(real_engine):
    robot = robot_in_scene(real_engine.gs, 2).robot
    robot.set_dofs_kp(kp := 2 * spec.FIRST.kp, range(len(kp)), envs_idx=[1])
    assert to_numpy(robot.get_dofs_kp()) == pytest.approx(kp)


@pytest.mark.parametrize(("mistake", "args", "shown", "says"), [
    (mistakes.one_value_each, ({1: 0.03, 3: 0.01}, {0: 0.03, 1: 0.01, 3: 0.02}), True, "20.0"),
    (mistakes.one_value_each, ({1: 0.03}, {3: 0.02}), False, "30.0 mm in 1"),
    (mistakes.numbers_as_rows, ([1, 3],), True, "`IndexError`"),
    (mistakes.mean_of_rows, (2, (0.82, 0.06, 0.32)), True, "`NotAccepted`: Rows [2]"),
    (mistakes.mean_of_rows, (2, spec.TARGETS[2]), False, "No exception"),
])  # fmt: skip
def test_a_symptom_is_found_where_it_appears(four, mistake, args, shown, says):
    found = mistake(*vars(four).values(), WORLDS, *args)
    assert (found.shown, says in found.evidence) == (shown, True), found.evidence
