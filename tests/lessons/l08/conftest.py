"""Episodes without Genesis: one arm by MuJoCo's mechanics for all, objects moved by hand."""

from dataclasses import replace

import numpy as np
import pytest
from robot_runs import LINKS, answer, driven

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Episodes
from robo_genesis.lessons.l08 import spec
from robo_genesis.lessons.l08.pages import LECTURE
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.kinematics import hand_pose

LENGTHS = (90, 45, 10, 60, 100, 45, 20, 60)
"""Outer steps of the phases; then the episode is done."""

SLIDE = 1.6e-3  # Speed of the object in the fingers [m/s]


@pytest.fixture(scope="session")
def arm():
    """The arm's run, and the phase at each of its states."""
    case = replace(spec.ASKEW, beliefs=np.array([[0.5, -0.1]]))
    q, ends = case.q_start, [case.q_start]
    for point in case.waypoints:
        q = answer(point[0], q, 60).q.astype(float)
        ends.append(np.concatenate([q[:7], case.q_start[7:]]))
    phase = np.repeat(range(8), LENGTHS)
    goals = np.array(ends[1:])[list(picking.OF_GOAL)]
    command = [case.q_start]
    for k in phase:
        way = goals[k] - command[-1]
        command.append(command[-1] + way * min(1, 0.012 / max(np.abs(way).max(), 1e-12)))
        command[-1][7:] = 0.0235 if 2 <= k < 6 else 0.04  # where the object would stop the fingers
    rest = case.control.steps - len(phase)
    commands = np.vstack([command[1:], np.tile(command[-1], (rest, 1))])
    run = driven(replace(case.control, q_target=commands), LINKS)
    return run, np.concatenate([[0], phase, np.full(rest, picking.DONE)])


def level_of(error: float) -> int:
    """Return the rungs of an episode by the error along the pads [m]."""
    return 7 if error > -4e-3 else 3 if error > -6.5e-3 else 2 if error > -9.5e-3 else 1


def path(start, level, arm, phase, dt) -> np.ndarray:
    """Return places of an object that follows the hand until it is lost."""
    hand = hand_pose(arm.q).position
    at = np.tile([*start, 0.035], (len(hand), 1))
    held = (phase >= picking.LIFT) & (phase < picking.OPEN)
    first, last = np.flatnonzero(held)[[0, -1]]
    if level > 2:
        moved = hand - hand[first]
        moved[:, 2] -= SLIDE * dt * (np.arange(len(hand)) - first)
        at[held] += moved[held]
        at[last + 1 :] = at[last] if level == 7 else [*start, 0.035]
        if level == 7:
            at[last + 1 :] = [*spec.ASKEW.bowl_at, 0.039]
    return np.float32(at)


def batch(case, arm) -> Episodes:
    """Return all episodes of a case."""
    (run, phase), every, n = arm, case.commands, len(case.starts)
    errors = (case.beliefs - case.starts)[:, 0]
    levels = [level_of(error) for error in errors]
    paths = [path(*of, run, phase, run.dt) for of in zip(case.starts, levels, strict=True)]
    at = np.stack(paths, axis=1)[::every]
    sampled = phase[::every]
    pressed = np.zeros((len(sampled), n, 2), np.float32)
    for k, level in enumerate(levels):
        until = {1: picking.CLOSE, 2: picking.MOVE, 3: picking.LOWER}.get(level, picking.OPEN)
        pressed[(sampled >= picking.LIFT) & (sampled < until), k] = 11.7
    return Episodes(
        t=np.arange(case.steps + 1) * case.dt,
        phase=np.tile(sampled[:, None], n).astype(np.int8),
        q=np.repeat(run.q[::every, None], n, axis=1),
        object_pos=at,
        object_quat=np.tile(np.float32([1, 0, 0, 0]), (*at.shape[:2], 1)),
        force=pressed,
        touches=(pressed.max(axis=2) > 0).astype(np.int8),
    )


@pytest.fixture(scope="session")
def episodes(arm, joints) -> Experiment:
    """A run of the lecture, without a camera, that passes its checks."""
    traces = {name: batch(case, arm) for name, case in spec.BATCHES.items()}
    for name, row in spec.SHOWN.items():
        at = path(spec.STARTS[row], spec.REACH[name], *arm, arm[0].dt)[:, None]
        quat = np.tile(np.float32([1, 0, 0, 0]), (*at.shape[:2], 1))
        traces[name] = replace(
            arm[0],
            link_pos=np.concatenate([arm[0].link_pos, at], axis=1),
            link_quat=np.concatenate([arm[0].link_quat, quat], axis=1),
        )
    return Experiment(
        page=LECTURE, traces=traces, links=[*LINKS, "object"],
        readings={"model": spec.EXPECTED_MODEL}, frames={}, rendered=False, joints=joints,
    )  # fmt: skip
