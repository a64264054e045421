"""Episodes without the engine: arms that reach what they believe, objects moved by hand."""

from dataclasses import fields, replace

import numpy as np
import pytest
from lessons.changed_runs import passed
from robot_runs import LINKS, solve

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Demonstrations, Episodes
from robo_genesis.lessons.l08 import metrics, spec
from robo_genesis.lessons.l08.pages import LAB, LECTURE
from robo_genesis.sim.arm import kinematics, picking
from robo_genesis.sim.bodies import bowl

SLIDE = 1.6e-3  # Speed of the object in the fingers [m/s]

LEAVING = 2.8  # Rate at which a held object leaves the pads beyond their end [1/s]

PADS = 4.75e-3  # How far the pads are from their command, towards the base [m]


def batch(
    case,
    level,
    hanging=False,
    early=False,
    falls_in=False,
    length=16,
    slide=SLIDE,
    leaving=LEAVING,
) -> Episodes:
    """Return a batch whose episodes reach these rungs (e,), each with phases of `length` samples.

    Objects may hang over the bowl in the hand, be touched `early`, or fall into the
    bowl although they were lost on the way. Beyond the end of the pads, a held one
    leaves them with the rate `leaving` [1/s].
    """
    rows, states = len(case.starts), np.arange(case.steps + 1)
    short = 0.0 if case.compensated else PADS
    length = length * np.ones(rows)
    phase = (states[:, None, None] >= np.multiply.outer(length, range(1, 9))).sum(2)
    lost = np.array([0, picking.CLOSE, picking.MOVE, picking.LOWER])
    until = np.where(level < 4, lost[np.minimum(level, 3)], picking.OPEN)
    held = (phase >= picking.LIFT) & (phase < until)
    carried = (phase >= picking.LIFT) & (phase < picking.OPEN) & (level > 2)
    begin = np.column_stack([case.starts, np.full(rows, case.size[2] / 2)])
    place = np.tile(begin, (len(states), 1, 1))
    place[..., 2] += 0.1 * carried - slide * case.dt * carried.cumsum(axis=0) * carried
    pads = case.beliefs[:, 0] - short
    beyond = np.maximum(case.starts[:, 0] - pads - metrics.HALF_PAD, 0)
    place[..., 0] += beyond * (np.exp(leaving * case.dt * held.cumsum(axis=0)) - 1)
    hangs = (phase >= picking.MOVE) & hanging
    place[hangs, 2] += 2 * bowl.HEIGHT
    inside = (phase >= picking.OPEN) & ((level == 7) | falls_in)
    place[hangs | inside, :2] = case.bowl_at
    target = kinematics.Pose(
        case.waypoints[1] - [short, 0, 0], np.tile([0.0, 1, 0, 0], (rows, 1))
    )
    limits, how = ([-3.0] * 7, [4.0] * 7), {"iterations": 60, "damping": 0.01}
    start = np.tile(case.q_start[:7], (rows, 1))
    ends = solve(target, start, *map(np.array, limits), **how)
    share = np.minimum(states[:, None] / (2 * length), 1)[..., None]
    shut = (phase >= picking.CLOSE) & (phase < picking.OPEN)
    fingers = np.where(shut, 0.0235, 0.04)[..., None].repeat(2, axis=2)
    return Episodes(
        t=states * case.dt,
        phase=phase.astype(np.int8),
        q=np.float32(np.dstack([start + share * (ends - start), fingers])),
        object_pos=np.float32(place),
        object_quat=np.float32(np.tile(case.turns, (len(states), 1, 1))),
        force=np.float32(11.7 * np.dstack([held, held])),
        touches=(held | hangs | ((phase == picking.DESCEND) & early)).astype(np.int8),
    )


def experiment(page, traces, joints) -> Experiment:
    """Return an experiment with the batches of a page alone, without a camera."""
    checks = [check for check in page.checks if check.__name__ != "posture"]
    page = replace(page, runs={name: page.runs[name] for name in traces}, checks=checks)
    known = {"model": spec.EXPECTED_MODEL}
    return Experiment(page, traces, [*LINKS, "object"], known, {}, False, joints)


def arrays_of(trace) -> dict[str, np.ndarray]:
    """Return the arrays of a batch by name."""
    return {of.name: getattr(trace, of.name) for of in fields(trace)}


@pytest.fixture(scope="session")
def episodes(joints) -> Experiment:
    """A run of the lecture that passes its checks."""
    error = (spec.ASKEW.beliefs - spec.STARTS)[:, 0]
    levels = [error > -3.75e-3, error > -6.5e-3, error > -8.3e-3]
    level = np.select(levels, [7, 3, 2], 1)
    askew = batch(spec.ASKEW, level, falls_in=(level == 3) & (error > -4.5e-3))
    exact = batch(spec.EXACT, np.full(len(spec.FEW), 7), length=10)
    ordered = {n: of[:, spec.ORDER] for n, of in arrays_of(exact).items() if n != "t"}
    everywhere = batch(spec.ROUND, np.full(len(spec.STARTS), 7), leaving=0.0)
    others = {"round": everywhere, "permuted": replace(exact, **ordered)}
    return experiment(LECTURE, {"exact": exact, "askew": askew} | others, joints)


@pytest.fixture(scope="session")
def lab(episodes) -> Experiment:
    """A run of the lab that passes its checks."""
    exact = episodes.traces["exact"]
    target = exact.q[1:].copy()
    target[:-2, :, :7] = exact.q[3:, :, :7]
    target[..., 7:] *= target[..., 7:] > 0.03
    traces = {"exact": Demonstrations(**arrays_of(exact), target=target)}
    run = experiment(LAB, traces, episodes.joints)
    return replace(run, readings=run.readings | passed(LAB))
