"""What L06 reads beside its runs, and how it compares two runs and explains a torque."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Readings, counts
from robo_genesis.lessons.l06 import spec
from robo_genesis.lessons.l06.run import World, ask, reach, reset_some, set_loads, start
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim import mujoco_kinematics
from robo_genesis.sim.arm_kinematics import ARM
from robo_genesis.sim.franka import JOINT_NAMES
from robo_genesis.sim.joints import JointMap, resolve_joints, to_numpy

GRAVITY = 9.81
"""The engine's gravity [m/s²]."""

HAND_CENTRE = np.array([-0.01, 0.0, 0.03])
"""Centre of mass of the hand in its frame, as in the model file [m]."""

SHAPES = {
    "axes_without_environments": 1,
    "axes_with_one_environment": 2,
    "axes_with_four_environments": 2,
    "rows_with_four_environments": 4,
    "rows_of_an_answer": 4,
    "rows_of_an_answer_for_two": 2,
}
"""Expected counts: axes and rows of joint positions, rows of answers."""

MIXED = {f"row_{k}_m": "m" for k in spec.ENVS}
"""Position residuals of a question with one target beyond reach."""

MASSES = dict.fromkeys(spec.VARIANTS, "kg")
"""Mass of each hand, as it reads back."""


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the groups of the engine's values on the lesson's pages."""
    return {
        "model": counts(spec.EXPECTED_MODEL),
        "shapes": counts(SHAPES),
        "mixed": Readings(MIXED),
        "hand_mass": Readings(MASSES),
    }


def describe(page: Any, robot: Any) -> JointMap:
    """Give a page the counts, links and joints of the robot, and return its joints."""
    counted = (robot.n_links, robot.n_joints, robot.n_dofs, robot.n_qs)
    page.readings["model"] = dict(zip(spec.EXPECTED_MODEL, counted, strict=True))
    page.links = [link.name for link in robot.links]
    page.joints = resolve_joints(robot, JOINT_NAMES)
    return page.joints


def read_shapes(page: Any, alone: Any, one: Any, robot: Any) -> None:
    """Give a page the shapes of positions and answers with 0, 1 and 4 environments.

    Args:
        page: the page.
        alone: robot of a scene without environments.
        one: robot of a scene with one environment.
        robot: robot of the scene with four.
    """
    axes = [to_numpy(of.get_dofs_position()).shape for of in (alone, one, robot)]
    worlds, envs = list(spec.WORLDS.values()), list(spec.LATER)
    some = ask(robot, page.joints, [worlds[k] for k in envs], 1, envs)
    found = (*map(len, axes), axes[2][0], len(ask(robot, page.joints, worlds).q), len(some.q))
    page.readings["shapes"] = dict(zip(SHAPES, found, strict=True))


def read_mixed(page: Any, robot: Any) -> None:
    """Give a page the residuals of a question in which one target is beyond reach."""
    world = replace(spec.FIRST, settings=spec.ONE_START)
    worlds = [replace(world, positions=target[None]) for target in spec.MIXED]
    apart, _ = kinematics.distances(ask(robot, page.joints, worlds).error)
    page.readings["mixed"] = dict(zip(MIXED, map(float, apart), strict=True))


def record(page: Any, scene: Any, robot: Any, camera: Any) -> None:
    """Record the four environments, with a frame before the first step and after the last."""
    worlds = list(spec.WORLDS.values())
    start(scene, robot, page.joints, worlds)
    page.capture(camera, "initial")
    page.traces |= dict(zip(spec.WORLDS, reach(scene, robot, page.joints, worlds), strict=True))
    page.capture(camera, "final")


def record_alone(page: Any, scene: Any, robot: Any) -> None:
    """Record each world in a scene without environments."""
    for name, world in spec.ALONE.items():
        (page.traces[name],) = reach(scene, robot, resolve_joints(robot, JOINT_NAMES), [world])


def record_copies(page: Any, scene: Any, robot: Any) -> None:
    """Record the permuted batch, and the batch of which some environments are reset."""
    worlds = [spec.WORLDS[f"env_{k}"] for k in spec.ENVS]
    rows = reach(scene, robot, page.joints, [worlds[k] for k in spec.ORDER])
    page.traces |= {f"permuted_{k}": rows[spec.ORDER.index(k)] for k in spec.ENVS}
    envs = list(spec.LATER)
    rows = reset_some(scene, robot, page.joints, worlds, envs, spec.RESET_AFTER)
    page.traces |= {f"{'again' if k in envs else 'beside'}_{k}": rows[k] for k in spec.ENVS}


def record_variants(page: Any, scene: Any, robot: Any) -> None:
    """Record four robots with one target, own gains and own loads; take the loads off again."""
    worlds = list(spec.VARIANTS.values())
    masses = set_loads(robot, worlds, spec.HAND_MASS)
    page.readings["hand_mass"] = dict(zip(MASSES, map(float, masses), strict=True))
    page.traces |= dict(zip(spec.VARIANTS, reach(scene, robot, page.joints, worlds), strict=True))
    set_loads(robot, [spec.FIRST] * len(worlds), spec.HAND_MASS)


def entries_that_differ(one: Trace, other: Trace) -> tuple[int, int]:
    """Return how many entries differ in the samples that two runs share, and how many these are."""
    differ = compared = 0
    for name in (field.name for field in fields(Trace) if field.name != "t"):
        a, b = getattr(one, name), getattr(other, name)
        n = min(len(a), len(b)) if a.ndim > 1 else len(a)
        differ += int((a[:n] != b[:n]).sum())
        compared += a[:n].size
    return differ, compared


def largest_differences(one: Trace, other: Trace) -> dict[str, float]:
    """Return the largest difference of each array of `spec.SAME_RUN` in two runs."""
    return {
        name: float(np.abs(getattr(one, name).astype(float) - getattr(other, name)).max())
        for name in spec.SAME_RUN
    }


def torque_at_rest(q: FloatArray, load: float) -> FloatArray:
    """Return the torques (7,) that hold the arm and a load in the hand against gravity [N·m].

    Args:
        q: (9,) joint positions [rad or m].
        load: mass at the hand's centre of mass [kg].
    """
    bare = mujoco_kinematics.gravity_effort(q)[:ARM]
    of, pose = kinematics.jacobian(q), kinematics.hand_pose(q)
    arm = kinematics.rotate(pose.quat, HAND_CENTRE)
    lift = of[:3] + np.cross(of[3:].T, arm).T  # of the centre of mass, (3, 7)
    return np.asarray(bare + load * GRAVITY * lift[2])


def pairs() -> Mapping[str, Sequence[tuple[str, str]]]:
    """Return by claim the pairs of runs that must be equal to the last bit."""
    return {
        "permuted": [(name, f"env_{name[-1]}") for name in spec.PERMUTED],
        "beside": [(name, f"env_{name[-1]}") for name in spec.BESIDE],
        "again": [(name, f"env_{name[-1]}") for name in spec.AGAIN],
        "plain": [("plain", "env_0")],
    }


def commanded(trace: Trace, world: World) -> list[FloatArray]:
    """Return the commands (9,) of a run in the order of its targets [rad or m]."""
    return [trace.target[0], trace.target[-1]][: len(world.positions)]
