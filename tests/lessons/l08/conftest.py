"""Episodes without Genesis: arms by MuJoCo's mechanics, objects moved by hand."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
from robot_runs import LINKS, answer, driven

from robo_genesis.core.exercises import FUNCTIONS
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Demonstrations, Episodes, Trace
from robo_genesis.lessons.l08 import spec
from robo_genesis.lessons.l08.checks import nothing_jumps
from robo_genesis.lessons.l08.pages import LAB, LECTURE
from robo_genesis.sim.arm import kinematics, picking
from robo_genesis.sim.arm.kinematics import hand_pose

# Outer steps of the phases; then the episode is done.
LENGTHS = (90, 45, 10, 60, 100, 45, 20, 60)

SLIDE = 1.6e-3  # Speed of the object in the fingers [m/s]


PADS = 4.75e-3  # How far the pads are from their command, towards the base [m]

DOWN = np.array([0.0, 1.0, 0.0, 0.0])

PHASES = np.concatenate([[0], np.repeat(range(8), LENGTHS)])


@cache
def arm(x: float, y: float) -> tuple[Trace, np.ndarray]:
    """Return the run of an arm that believes the object at (x, y), and the phase at each state."""
    case = replace(spec.ASKEW, beliefs=np.array([[x, y]]))
    q, ends = case.q_start, []
    for point in case.waypoints:
        q = answer(point[0], q, 60).q.astype(float)
        ends.append(np.concatenate([q[:7], case.q_start[7:]]))
    goals = np.array(ends)[list(picking.OF_GOAL)]
    command = [case.q_start]
    for k in PHASES[1:]:
        way = goals[k] - command[-1]
        way[7:] = 0  # the fingers have their own command
        command.append(
            command[-1] + way * min(1, 0.012 / max(np.abs(way).max(), 1e-12))
        )
        command[-1][7:] = (
            0.0235 if 2 <= k < 6 else 0.04
        )  # where the object would stop the fingers
    rest = case.control.steps + 1 - len(PHASES)
    commands = np.vstack([command[1:], np.tile(command[-1], (rest, 1))])
    run = driven(replace(case.control, q_target=commands), LINKS)
    return run, np.concatenate([PHASES, np.full(rest, picking.DONE)])


def level_of(error: float) -> int:
    """Return the rungs of an episode by the error along the pads [m]."""
    return (
        7 if error > -3.75e-3 else 3 if error > -6.5e-3 else 2 if error > -9.5e-3 else 1
    )


def path(start, level, arm, falls_in=False) -> np.ndarray:
    """Return places of an object that follows the hand until it is lost."""
    run, phase = arm
    hand = hand_pose(run.q).position
    at = np.tile([*start, 0.035], (len(hand), 1))
    held = (phase >= picking.LIFT) & (phase < picking.OPEN)
    first, last = np.flatnonzero(held)[[0, -1]]
    if level > 2:
        moved = hand - hand[first]
        moved[:, 2] -= SLIDE * run.dt * (np.arange(len(hand)) - first)
        at[held] += moved[held]
        in_bowl = level == 7 or falls_in
        at[last + 1 :] = [*spec.ASKEW.bowl_at, 0.039] if in_bowl else [*start, 0.035]
    return np.float32(at)


def batch(case, own) -> Episodes:
    """Return all episodes of a case; `own` are arms of some of them, by number."""
    every, n = case.commands, len(case.starts)
    arms = [own.get(k, next(iter(own.values()))) for k in range(n)]
    errors = (case.beliefs - case.starts)[:, 0]
    levels = [level_of(error) for error in errors]
    falls = (errors < -3.75e-3) & (errors > -4.5e-3)
    at = np.stack(
        [path(*of) for of in zip(case.starts, levels, arms, falls, strict=True)], axis=1
    )
    sampled = arms[0][1][::every]
    q = np.stack([run.q[::every] for run, _ in arms], axis=1)
    others = [k for k in range(n) if k not in own]
    closing = int((sampled >= picking.CLOSE).argmax())
    hand = hand_pose(q[closing, others]).position
    hand[:, :2] = case.beliefs[others] - [PADS, 0]
    target = kinematics.Pose(hand, np.tile(DOWN, (len(others), 1)))
    limits = (np.full(7, -3.0), np.full(7, 4.0))
    solved = kinematics.solve(
        target, q[closing, others, :7], *limits, iterations=60, damping=0.01
    )
    q[closing, others, :7] = solved
    pressed = np.zeros((len(sampled), n, 2), np.float32)
    for k, level in enumerate(levels):
        until = {1: picking.CLOSE, 2: picking.MOVE, 3: picking.LOWER}.get(
            level, picking.OPEN
        )
        pressed[(sampled >= picking.LIFT) & (sampled < until), k] = 11.7
    return Episodes(
        t=np.arange(case.steps + 1) * case.dt,
        phase=np.tile(sampled[:, None], n).astype(np.int8),
        q=np.float32(q),
        object_pos=at[::every],
        object_quat=np.tile(np.float32([1, 0, 0, 0]), (*at[::every].shape[:2], 1)),
        force=pressed,
        touches=(pressed.max(axis=2) > 0).astype(np.int8),
    )


def whole(arm, start, level) -> Trace:
    """Return an episode at all its steps."""
    at = path(start, level, arm)[:, None]
    quat = np.tile(np.float32([1, 0, 0, 0]), (*at.shape[:2], 1))
    return replace(
        arm[0],
        link_pos=np.concatenate([arm[0].link_pos, at], axis=1),
        link_quat=np.concatenate([arm[0].link_quat, quat], axis=1),
    )


def without_motion(page):
    """Return a page without the check of motion: only some arms are driven."""
    return replace(page, checks=[of for of in page.checks if of != nothing_jumps])


@pytest.fixture(scope="session")
def episodes(joints) -> Experiment:
    """A run of the lecture, without a camera, that passes its checks."""
    own = {row: arm(*spec.ASKEW.beliefs[row].tolist()) for row in spec.SHOWN.values()}
    askew, exact = (
        batch(spec.ASKEW, own),
        batch(spec.EXACT, {0: arm(*spec.FEW[0].tolist())}),
    )
    names = [of.name for of in fields(askew) if of.name != "t"]
    permuted = replace(
        askew, **{name: getattr(askew, name)[:, spec.ORDER] for name in names}
    )
    traces = {"exact": exact, "again": exact, "askew": askew, "permuted": permuted}
    traces |= {
        n: whole(own[k], spec.STARTS[k], spec.REACH[n]) for n, k in spec.SHOWN.items()
    }
    return Experiment(
        page=without_motion(LECTURE),
        traces=traces,
        links=[*LINKS, "object"],
        readings={"model": spec.EXPECTED_MODEL},
        frames={},
        rendered=False,
        joints=joints,
    )


def demonstrated(batch: Episodes) -> Demonstrations:
    """Return a batch with the commands that its arms followed, which close the fingers wholly."""
    parts = {of.name: getattr(batch, of.name) for of in fields(batch)}
    run, _ = arm(*spec.FEW[0].tolist())
    target = np.float32(run.target[4::5][:, None]).repeat(batch.phase.shape[1], axis=1)
    target[..., 7:] = np.where(target[..., 7:] < 0.03, 0, target[..., 7:])
    return Demonstrations(**parts, target=target)


@pytest.fixture(scope="session")
def lab(episodes) -> Experiment:
    """A run of the lab that passes its checks."""
    traces = {name: episodes.traces[name] for name in ("exact",)}
    traces["exact"] = demonstrated(traces["exact"])
    passed = {FUNCTIONS: dict.fromkeys(LAB.readings[FUNCTIONS].units, 1)}
    return replace(
        episodes,
        page=without_motion(LAB),
        traces=traces | {"one": whole(arm(*spec.FEW[0].tolist()), spec.FEW[0], 7)},
        readings=episodes.readings | passed,
    )
