"""Checks of the functions that a student writes in L08's lab; see `core/exercises.py`."""

from functools import partial
from itertools import product
from math import nan
from typing import Any

import numpy as np

from robo_genesis.core import statistics
from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.exercises import (
    Written,
    as_test,
    compared,
    refused,
    same_array,
)
from robo_genesis.sim.arm import lifting, picking
from robo_genesis.sim.arm.kinematics import ARM

from . import metrics

MEASURES = False

# Place of the lower face and height of an object [m]
OBJECTS = {
    "on_the_table": ((0.5, -0.1, 0.0), 0.07),
    "above_the_bowl": ((0.55, 0.22, 0.02), 0.031),
    "behind": ((-0.61234, 0.3, -0.2), 0.05),
}


@as_test
def grasp(grasp_pose: Written) -> Findings:
    """Check `grasp_pose(place, height)`: positions of the hand at pregrasp and grasp [m]."""
    for name, (place, height) in OBJECTS.items():
        right = np.array(lifting.waypoints(place, height)[:2])
        found = grasp_pose(np.array(place), height)
        yield from same_array(f"{name}.pregrasp_and_grasp_m", found, right, 1e-6)


AT, SLOW, STILL = picking.ARRIVED, picking.SLOW, picking.STILL

# Whether a phase of the arm ends and one of the fingers, and by array and joint what is
# added to an arm at its goal with still fingers
STATES: dict[str, Any] = {
    "at_its_goal": (True, True, {}),
    "nan": (False, True, {("q", 2): nan}),
    "nan_of_a_finger": (True, False, {("qd", 8): nan}),
    "nan_of_a_speed": (False, True, {("qd", 4): nan}),
    "near": (True, True, {("q", k): 0.98 * AT * (-1) ** k for k in range(ARM)}),
    "slow": (True, True, {("qd", k): 0.98 * SLOW * (-1) ** k for k in range(ARM)}),
    "at": (False, True, {("q", 3): AT}),
    "at_the_speed": (False, True, {("qd", 3): SLOW}),
    "a_turn_away": (False, True, {("q", 6): 2 * np.pi}),
    "fingers_opposed": (True, False, {("qd", 7): -0.1, ("qd", 8): 0.1}),
    "almost_still": (True, True, {("qd", 7): 0.98 * STILL, ("qd", 8): -0.98 * STILL}),
    "finger_at_the_speed": (True, False, {("qd", 8): STILL}),
    "left": (True, False, {("qd", 7): -1.02 * STILL}),
    "right": (True, False, {("qd", 8): 1.02 * STILL}),
} | {
    f"joint_{k}_of_{array}": (False, True, {(array, k): sign * 1.02 * limit})
    for array, limit, sign in (("q", AT, 1), ("q", AT, -1), ("qd", SLOW, -1))
    for k in range(ARM)
}


@as_test
def ends(ended: Written) -> Findings:
    """Check `ended(q, qd, goal, of_fingers, since)`: first row by row, then on all rows."""
    rows: list[tuple[Any, ...]] = []
    for shift, (name, (*expected, changed)) in enumerate(STATES.items()):
        goal = np.append(np.where(np.arange(ARM) == 3, 0.0, 0.1 * shift), [0.04, 0.04])
        state = {"q": goal.copy(), "qd": np.zeros(ARM + 2)}
        for (array, joint), value in changed.items():
            state[array][joint] += value
        for since, of_fingers in product((1, 4, 5, 300), (False, True)):
            early = of_fingers and since < picking.CLOSING
            right = expected[of_fingers] and not early
            rows.append((*state.values(), goal[:ARM], of_fingers, since, right))
            label = f"{name}.of_fingers_{of_fingers}_since_{since}"
            yield equal(label, ended(*rows[-1][:-1]), right)
    *batch, answers = (np.array(column) for column in zip(*rows, strict=True))
    found = np.asarray(ended(*batch))
    yield equal("batch.shape", str(found.shape), str((len(rows),)))
    yield equal("batch.wrong_rows", np.flatnonzero(found != answers).tolist(), [])


PHASES = np.array([0, 1, 2, 3, 3, 4, 4, 5, 6, 7, 8, 8, 8, 8, 8, 8])
END, RIM = slice(9, None), (0.55, 0.22, 0.05)

# Array, index and value of each fault of an episode, and how many rungs the episode
# passes
EPISODES: dict[str, Any] = {
    "success": (7,),
    "bowl_elsewhere": ("rim", 0, 0.3, "pos", (END, 0), 0.3, 7),
    "done_at_first": ("phase", 0, 8, 0),
    "done_before_it_begins": ("phase", [0, 1], [8, 0], 0),
    "no_lift": ("phase", [3, 4], 2, 1),
    "begins_later": ("phase", 0, 1, 7),
    "held_at_first": ("force", 4, 0.0, 7),
    "held_at_last": ("force", 3, 0.0, 7),
    "dropped_before": ("pos", (1, 2), 0.0, "pos", (5, 2), 0.06, 2),
    "no_move": ("phase", [5, 6], 3, 7),
    "lost_and_caught": ("force", (6, 1), 0.0, 3),
    "fingers_in_turn": ("force", ([3, 4], [0, 1]), 0.0, 1),
    "rises_late": ("pos", (5, 2), 0.08, 2),
    "lifted_to_the_limit": ("pos", (0, 2), 0.0, "pos", (5, 2), metrics.RAISED, 7),
    "no_move_no_lower": ("phase", [5, 6, 7], 6, 3),
    "lost_then": ("force", (7, 1), 0.0, 3),
    "lost_at_the_limit": ("force", (5, 1), 0.1, 3),
    "not_done": ("phase", -1, 7, 4),
    "touched_at_the_end": ("touches", -1, 1, 4),
    "touched_before": ("touches", -2, 1, 7),
    "nan": ("lowest", (), nan, 5),
    "there_at_last": ("pos", (slice(9, 15), 0), 0.3, 6),
    "beside_it": ("pos", (END, 1), 0.15, 5),
    "inside_the_diagonal": ("pos", (END, slice(0, 2)), [0.59, 0.26], 7),
    "diagonal": ("pos", (END, slice(0, 2)), [0.5, 0.27], 5),
    "on_rim": ("lowest", (), 0.041, 5),
    "at_the_depth": ("rim", 2, 0.02, "lowest", (), 0.01, 5),
    "at_the_distance": ("rim", [0, 1], 0, "pos", (END, slice(0, 2)), [0.06, 0], 5),
    "high_rim": ("rim", 2, 0.2, "lowest", (), 0.18, 7),
    "moved_before": ("pos", 10, 0.55, 7),
    "moves_at_first": ("pos", (11, 0), 0.5503, 6),
    "moves_at_last": ("pos", (15, 2), 0.0403, 6),
    "moves_near_the_end": ("pos", (14, 0), 0.5503, 6),
    "in_two_directions": ("pos", 12, [0.55015, 0.2201, 0.04], 7),
    "in_all_directions": ("pos", 12, [0.55015, 0.22015, 0.04015], 6),
    "both_ways": ("pos", ([11, 12], 0), [0.55015, 0.54985], 7),
}


def episode(*faults: Any) -> list[Any]:
    """Return the arguments of `rungs` for a successful episode with faults."""
    closed = (PHASES >= picking.LIFT) & (PHASES < picking.OPEN)
    pos = np.where(closed[:, None], [0.5, -0.1, 0.15], [0.5, -0.1, 0.035])
    pos[PHASES >= picking.OPEN] = *RIM[:2], 0.04
    found = {
        "phase": PHASES.copy(),
        "force": np.outer(closed, [12.0, 12.0]),
        "pos": pos,
        "touches": closed * 1,
        "lowest": np.array(0.005),
        "rim": np.array(RIM),
    }
    for name, index, value in zip(faults[::3], faults[1::3], faults[2::3], strict=True):
        found[name][index] = value
    return [of if of.ndim else float(of) for of in found.values()]


@as_test
def ladders(rungs: Written) -> Findings:
    """Check `rungs(phase, force, pos, touches, lowest, rim)`: rungs before the first failure."""
    for name, (*faults, expected) in EPISODES.items():
        yield equal(name, rungs(*episode(*faults)), expected)


RATES = ((0, 1), (1, 1), (0, 64), (64, 64), (1, 3), (45, 64), (7, 1000))


@as_test
def intervals(wilson: Written) -> Findings:
    """Check `wilson(k, n)`: both ends of the interval, or ValueError."""
    for k, n in RATES:
        right = statistics.wilson(k, n)
        yield from compared(
            f"{k}_of_{n}", ("lower", "upper"), wilson(k, n), right, 1e-9
        )
    for given in ((0, 0), (1, 0), (0, -3), (5, 4), (-1, 4)):
        raised = type(refused(partial(wilson, *given))).__name__
        yield equal(f"{given[0]}_of_{given[1]}.raises", raised, "ValueError")


# Times [s], and distances by which the object has slid down [m]
SLIDES = {
    "steady": ([2.0, 2.05, 2.1], [0.0, 1e-4, 2e-4]),
    "upwards": ([0.0, 2.0], [0.09, 0.05]),
    "outlier_at_the_end": ([3.0, 3.1, 3.2, 3.3, 3.4], [0.0, 1e-3, 2e-3, 3e-3, 9e-3]),
    "uneven_times": ([0.0, 0.1, 0.5, 0.6, 2.0], [0.0, 2e-3, 3e-3, 9e-3, 9e-3]),
}


@as_test
def sliding(creep: Written) -> Findings:
    """Check `creep(hand_z, object_z, t)`: the least-squares speed downwards [m/s]."""
    for name, (times, slid) in SLIDES.items():
        t, down = np.array(times), np.array(slid)
        right = float(np.polyfit(t - t.mean(), down, 1)[0])
        for moves, hand in (("at_rest", 0 * t + 0.3), ("moving", 0.3 + 0.2 * t**2)):
            found = creep(hand, hand - 0.1 - down, t)
            yield from same_array(f"{name}.hand_{moves}_m_s", found, right, 1e-9)
