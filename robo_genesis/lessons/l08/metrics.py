"""Success as a ladder: which rungs the episodes of a batch reach, and what other words count."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Episodes
from robo_genesis.sim.arm.kinematics import hand_pose, rotate
from robo_genesis.sim.arm.ladder import BELOW as BELOW
from robo_genesis.sim.arm.ladder import CENTRED as CENTRED
from robo_genesis.sim.arm.ladder import PRESSES as PRESSES
from robo_genesis.sim.arm.ladder import RAISED as RAISED
from robo_genesis.sim.arm.ladder import STILL as STILL
from robo_genesis.sim.arm.ladder import (
    contained,
    count,
    lowest,
    off_axis,
    pressed,
    resting,
    risen,
)
from robo_genesis.sim.arm.lifting import HAND_TO_PAD
from robo_genesis.sim.arm.picking import CLOSE, DONE, LIFT, LOWER, MOVE, PickCase
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.free_fall import GRAVITY

# Half of the length of a pad [m].
HALF_PAD = 8.5e-3

# Distances beyond the end of the pads at which an object leaves them [m], and the least
# number of such episodes.
LEAVING, FEWEST = (5e-4, 12e-3), 10


def rungs(trace: Episodes, case: PickCase) -> dict[str, np.ndarray]:
    """Return by rung which episodes (e,) pass it, whatever the others say."""
    both = pressed(trace)
    carry = (trace.phase == MOVE) | (trace.phase == LOWER)
    at_move = (trace.phase >= MOVE).argmax(axis=0)
    return {
        "planned": trace.phase[0] < DONE,
        "held": (both & (trace.phase == LIFT)).any(axis=0),
        "lifted": risen(trace)[at_move, np.arange(len(at_move))] >= RAISED,
        "carried": carry.any(axis=0) & (both | ~carry).all(axis=0),
        "released": (trace.phase[-1] == DONE) & (trace.touches[-1] == 0),
        "contained": contained(trace, case),
        "resting": resting(trace),
    }


# The rungs in their order.
RUNGS = ("planned", "held", "lifted", "carried", "released", "contained", "resting")


def reached(trace: Episodes, case: PickCase) -> np.ndarray:
    """Return how many rungs each episode passes before the first that it fails (e,)."""
    return count(rungs(trace, case))


def good(trace: Episodes, case: PickCase) -> np.ndarray:
    """Return which episodes (e,) reach the last rung."""
    return reached(trace, case) == len(RUNGS)


# Arrays from which the rungs follow, up to the rung of the same name.
HELD = ("phase", "force_N")
CARRIED = (*HELD, "object_pos_m")
RELEASED = (*CARRIED, "touches")


@dataclass(frozen=True, slots=True)
class EpisodesMetrics(CaseMetrics):
    """How many episodes reach each rung, and how many other words would count."""

    planned: float = metric("1", "planned", "phase")
    held: float = metric("1", "held", *HELD)
    lifted: float = metric("1", "lifted", *CARRIED)
    carried: float = metric("1", "carried", *CARRIED)
    released: float = metric("1", "released", *RELEASED)
    contained: float = metric("1", "contained", *RELEASED)
    resting: float = metric("1", "success", *RELEASED)
    finished: float = metric("1", "all phases done", "phase")
    raised_once: float = metric("1", "lifted at some time", "object_pos_m")
    in_bowl: float = metric(
        "1", "in the bowl at the end", "object_pos_m", "object_quat_wxyz"
    )
    over_bowl: float = metric("1", "over the bowl at the end", "object_pos_m")
    hanging: float = metric(
        "1", "of these, above the rim and touched", "object_pos_m", "touches"
    )
    upper: float = metric("1", "success among the half with larger y", *RELEASED)
    short: float = metric(
        "m", "pads nearer to the base than believed", "q_rad_or_m", "phase"
    )
    press: float = metric("N", "force of a finger in the move", "force_N", "phase")
    creep: float = metric(
        "m/s",
        "slide in the fingers in the move",
        "q_rad_or_m",
        "object_pos_m",
        noun="speed at which the object slides in the fingers",
    )
    leaving: float = metric(
        "1/s", "growth beyond a pad's end by force and creep", *CARRIED, "q_rad_or_m"
    )
    growth: float | None = metric(
        "1/s", "growth of the distance beyond a pad's end", *CARRIED, "q_rad_or_m"
    )


def episodes_metrics(trace: Episodes, case: PickCase) -> EpisodesMetrics:
    """Count episodes of one batch."""
    level, passed = reached(trace, case), rungs(trace, case)
    over = off_axis(trace, case)[-1] < CENTRED
    hanging = (trace.touches[-1] == 1) & (lowest(trace, case)[-1] > bowl.HEIGHT)
    press, slide = grip(trace, level > RUNGS.index("carried"))
    weight = case.density * case.volume * GRAVITY
    values: list[Any] = [
        *((level > k).sum() for k in range(len(RUNGS))),
        (trace.phase[-1] == DONE).sum(),
        (risen(trace).max(axis=0) >= RAISED).sum(),
        passed["contained"].sum(),
        over.sum(),
        (over & hanging).sum(),
        (level[case.starts[:, 1] > np.median(case.starts[:, 1])] == len(RUNGS)).sum(),
        np.median(case.beliefs[:, 0] - at_closing(trace)[:, 0]),
        press,
        slide,
        # A load creeps with a speed in proportion. At the distance e beyond the end both
        # fingers push a cylinder with 2 N e / r.
        2 * press / (case.size[0] / 2) * slide / weight,
        growth(trace),
    ]
    return EpisodesMetrics(*values)


def hand_above(trace: Episodes) -> FloatArray:
    """Return how far the hand is above the object (n+1, e) [m]."""
    return hand_pose(trace.q).position[..., 2] - trace.object_pos[..., 2]


def slides(trace: Episodes) -> tuple[FloatArray, FloatArray]:
    """Return how long each object is held, from lift to lower (e,) [s], and how far it
    slides down in the fingers meanwhile (e,) [m].
    """
    held = (trace.phase >= LIFT) & (trace.phase <= LOWER)
    rows = np.arange(held.shape[1])
    above = hand_above(trace)
    first, last = held.argmax(axis=0), len(held) - 1 - held[::-1].argmax(axis=0)
    return trace.t[last] - trace.t[first], above[last, rows] - above[first, rows]


def at_closing(trace: Episodes) -> FloatArray:
    """Return where the middle of the pads is (e, 3) when the fingers begin to close [m]."""
    hand = hand_pose(trace.q[first_closing(trace), np.arange(trace.phase.shape[1])])
    return hand.position + rotate(hand.quat, np.array([0.0, 0.0, HAND_TO_PAD]))


def offset(trace: Episodes) -> FloatArray:
    """Return how far the object is from the middle of the pads, along them (n+1, e) [m]."""
    hand = hand_pose(trace.q)
    middle, along = (
        rotate(hand.quat, np.array(of)) for of in ((0, 0, HAND_TO_PAD), (1.0, 0, 0))
    )
    return np.asarray(
        ((trace.object_pos - hand.position - middle) * along).sum(axis=-1)
    )


def growth(trace: Episodes) -> float | None:
    """Return how the speed of an object that leaves the pads grows with its distance [1/s].

    These are objects that both fingers press while their middle is beyond the end of the
    pads, at distances between both of `LEAVING`. With less than `FEWEST` of them the
    rate is not observed.
    """
    beyond = np.abs(offset(trace)) - HALF_PAD
    leaves = pressed(trace) & (trace.phase >= CLOSE) & (trace.phase <= MOVE)
    leaves &= (beyond > LEAVING[0]) & (beyond < LEAVING[1])
    leaves = leaves[1:] & leaves[:-1]
    if leaves.any(axis=0).sum() < FEWEST:
        return None
    speed = np.diff(beyond, axis=0)[leaves] / trace.dt
    middle = (beyond[1:] + beyond[:-1])[leaves] / 2
    return np.polyfit(middle, speed, 1)[0]


def first_closing(trace: Episodes) -> np.ndarray:
    """Return the first sample (e,) at which the fingers close."""
    return (trace.phase >= CLOSE).argmax(axis=0)


def grip(trace: Episodes, held: np.ndarray) -> tuple[float, float]:
    """Return force of a finger [N] and downward slide of the object [m/s], medians over the move.

    `held` (e,) are the episodes that count. The first and the last sample of a move do
    not.
    """
    inner = inside_move(trace) & held
    speed = np.gradient(hand_above(trace), trace.dt, axis=0)
    return float(np.median(trace.force[inner])), float(np.median(speed[inner]))


def inside_move(trace: Episodes) -> np.ndarray:
    """Return the samples (n+1, e) of the move without its first and its last one."""
    moving = trace.phase == MOVE
    return moving & np.roll(moving, 1, 0) & np.roll(moving, -1, 0)
