"""Mistakes made on purpose with many environments.

Every function makes one mistake and measures its symptom. Do not copy them.
"""

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l06 import spec
from robo_genesis.lessons.l06.metrics import measured_hand
from robo_genesis.lessons.l06.run import Environment, ask, commands
from robo_genesis.lessons.l06.throughput import Build, start
from robo_genesis.sim.arm.batch import Batch
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.throughput import calls_of, seconds_per_step

MEASURES = False

COMPILING = "Compiling"
"""How a line of the engine's log begins when `build` compiles kernels, or loads stored ones."""


def begin(scene: Any, robot: Any, joints: JointMap, worlds: Sequence[Environment]) -> Batch:
    """Return a batch at the start of its worlds, commanded to stay there."""
    cases = [world.commanding(world.q_start) for world in worlds]
    batch = Batch(scene, robot, joints, cases)
    batch.command(np.stack([case.q_target for case in cases]))
    return batch


def distances(trace: Trace, target: FloatArray) -> FloatArray:
    """Return the distance of the hand from a point in all states (n+1,) [m]."""
    return np.asarray(np.linalg.norm(measured_hand(trace, slice(None)).position - target, axis=1))


def one_value_each(
    scene: Any, robot: Any, joints: JointMap, worlds: Sequence[Environment],
    *openings: Mapping[int, float],
) -> Mistake:  # fmt: skip
    """Give one opening for each environment [m] to both fingers, for several lists of environments.

    The symptom is expected of the first list alone.
    """
    text, apart = [], []
    for opened in openings:
        batch = begin(scene, robot, joints, worlds)
        fingers, envs, meant = batch.dofs[ARM:], list(opened), list(opened.values())
        robot.control_dofs_position(meant, fingers, envs_idx=envs)  # the mistake
        batch.step(100)
        found = to_numpy(robot.get_dofs_position(fingers))[envs].mean(axis=1)
        apart.append(np.abs(found - meant).max())
        ends = listed([f"{1000 * end:.1f} mm in {k}" for k, end in zip(envs, found, strict=True)])
        text.append(f"With the environments {envs}, the fingers end at {ends}.")
    return Mistake("one_value_each", bool(apart[0] > 1e-3 > max(apart[1:])), " ".join(text))


def numbers_as_rows(
    scene: Any, robot: Any, joints: JointMap, worlds: Sequence[Environment], envs: Sequence[int]
) -> Mistake:
    """Ask for some environments, and take the row with the number of the first of them."""
    batch, first = begin(scene, robot, joints, worlds), envs[0]
    q = commands([worlds[k] for k in envs], ask(robot, joints, [worlds[k] for k in envs], 1, envs))
    batch.command(q[[first]], [first])  # the mistake: row 0 is the answer for envs[0]
    batch.step(spec.SWITCH)
    trace = batch.trace(first)
    own, theirs = (distances(trace, worlds[k].positions[1])[-1] for k in (first, envs[-1]))
    text = (
        f"The hand of environment {first} ends {1000 * own:.1f} mm from its target and "
        f"{1000 * theirs:.1f} mm from the target of environment {envs[-1]}. The line for "
        f"environment {envs[-1]}: {quoted(refused(lambda: q[envs[-1]]))}"
    )
    return Mistake("numbers_as_rows", bool(own > 0.05 and theirs < spec.REACHED[0]), text)


def mean_of_rows(
    scene: Any, robot: Any, joints: JointMap, worlds: Sequence[Environment], row: int, position: Any
) -> Mistake:
    """Give one environment a target beyond its reach, and judge the mean over all environments."""
    worlds = [replace(world, settings=spec.ONE_START) for world in worlds]
    worlds[row] = replace(worlds[row], positions=np.array([position], dtype=float))
    answer, batch = ask(robot, joints, worlds), begin(scene, robot, joints, worlds)
    batch.command(np.hstack([answer.q[:, :ARM], batch.q_start[:, ARM:]]))
    batch.step(spec.SWITCH)
    far = [distances(batch.trace(k), world.positions[0]) for k, world in enumerate(worlds)]
    apart, limit, t = 1000 * np.stack(far), 1000 * spec.REACHED[0], batch.trace(row).t
    mean, ends, nearest = apart.mean(axis=0), apart[:, -1], apart[row].argmin()  # the mistake: mean
    text = (
        f"The mean distance at the end is {mean[-1]:.1f} mm, below {limit:g} mm. The distances are "
        f"{', '.join(f'{end:.1f}' for end in ends)} mm. The hand of environment {row} is nearest "
        f"after {t[nearest]:.2f} s, {apart[row, nearest]:.1f} mm away. Asked before the run, the "
        f"rule for each row says: {quoted(refused(lambda: commands(worlds, answer)))}"
    )
    curves = {"mean of all": (t, mean), f"environment {row}": (t, apart[row])}
    return Mistake(
        "mean_of_rows", bool(mean[-1] < limit < ends[row]), text, curves, "distance [mm]"
    )


def timed_with_building(
    build: Build, lines: Sequence[Any], sizes: Sequence[int], steps: int
) -> Mistake:
    """Start the clock before the scene is built. No time decides whether the symptom appeared.

    Args:
        build: makes a scene.
        lines: of the engine's log, which grows.
        sizes: two numbers of environments.
        steps: that are timed.
    """
    wrong, right, compiled = [], [], []
    for size in sizes:
        known, clock = len(lines), time.perf_counter()
        scene, robot, *_ = build(size)  # the mistake: the clock is running
        calls = calls_of(scene, robot)
        seconds_per_step(calls, steps, time.perf_counter)
        wrong.append(1000 * (time.perf_counter() - clock) / steps)
        compiled.append(any(text.startswith(COMPILING) for _, text in lines[known:]))
        start(robot)
        right.append(1000 * seconds_per_step(calls, steps, time.perf_counter))
    few, many = sizes
    text = (
        f"Result: {wrong[0]:.1f} ms with {few} environment and {wrong[1]:.1f} ms with {many}, "
        f"{wrong[1] / wrong[0]:.2f} times as much. Timed after building and a warm-up, a step "
        f"takes {right[0]:.2f} ms and {right[1]:.2f} ms, {right[1] / right[0]:.2f} times as much."
    )
    return Mistake("timed_with_building", all(compiled), text)
