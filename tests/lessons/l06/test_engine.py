"""Worlds in the real engine: rows, subsets, refusals."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from lessons.engine_scenes import robot_in_scene

from robo_genesis.lessons.l06 import spec, study
from robo_genesis.lessons.l06.metrics import world_metrics
from robo_genesis.lessons.l06.run import ask, reach
from robo_genesis.sim.arm.batch import Batch, set_link_mass
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


def test_answers_of_some_environments_are_those_of_all(four):
    every = ask(four.robot, four.joints, WORLDS)
    some = ask(four.robot, four.joints, [WORLDS[3], WORLDS[1]], envs=[3, 1])
    assert (some.q == every.q[[3, 1]]).all()
    assert (some.error == every.error[[3, 1]]).all()


def test_a_command_to_an_environment_that_does_not_exist_is_refused(four):
    cases = [world.commanding(world.q_start) for world in WORLDS]
    batch = Batch(**vars(four), cases=cases)
    with pytest.raises(IndexError):
        batch.command(spec.FIRST.q_start[None], [4])


def test_a_mass_is_that_of_one_environment_and_survives_a_reset(four):
    set_link_mass(four.robot, "hand", [1.0], [1])
    four.scene.reset()
    assert set_link_mass(four.robot, "hand", [0.73], [2]) == pytest.approx(
        [0.73, 1, 0.73, 0.73]
    )
    assert set_link_mass(four.robot, "hand", [0.73], [1]) == pytest.approx([0.73] * 4)


def test_friction_is_that_of_one_environment_until_a_reset(four):
    four.robot.set_friction_ratio([[0.5]], [four.robot.n_links - 1], envs_idx=[2])
    ratio = four.scene.rigid_solver.get_geoms_friction_ratio
    assert to_numpy(ratio())[:, -1].tolist() == [1, 1, 0.5, 1]
    four.scene.reset()
    assert (to_numpy(ratio()) == 1).all()


@pytest.mark.parametrize("size", [2, 64])
def test_rows_of_batches_of_other_sizes_agree_within_the_bounds(
    real_engine, measured, size
):
    worlds = [WORLDS[k % len(WORLDS)] for k in range(size)]
    runs = reach(**vars(robot_in_scene(real_engine.gs, size, **EACH)), worlds=worlds)
    for k, run in enumerate(runs):
        apart = study.largest_differences(run, measured[f"env_{k % len(WORLDS)}"])
        assert all(apart[array] <= most for array, most in spec.SAME_RUN.items()), (
            k,
            apart,
        )
        assert (
            study.entries_that_differ(run, runs[k % len(WORLDS)])[0] == 0
        )  # the same world


def test_without_its_option_a_scene_has_one_set_of_gains_whatever_environment_is_named(
    real_engine,
):
    robot = robot_in_scene(real_engine.gs, 2).robot
    robot.set_dofs_kp(kp := 2 * spec.FIRST.kp, range(len(kp)), envs_idx=[1])
    assert to_numpy(robot.get_dofs_kp()) == pytest.approx(kp)


@pytest.mark.parametrize("substeps", [4, 8])
def test_a_stiff_arm_passes_its_target_farther_at_a_finer_step_as_well(
    real_engine, substeps
):
    robots = [
        replace(of, substeps=substeps) for of in spec.VARIANTS.values() if not of.load
    ]
    scene = robot_in_scene(real_engine.gs, len(robots), substeps, **EACH)
    runs = reach(**vars(scene), worlds=robots)
    plain, stiff, unlimited = (m.overshoot for m in map(world_metrics, runs, robots))
    assert 0.08 > stiff > 5 * max(plain, unlimited)
