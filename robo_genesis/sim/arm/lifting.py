"""Lifting an object from above: waypoints, postures, what they touch, the command, the contacts.

The fingers close along y of the world. A support is at z = 0, the height of the robot's
base.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray

from .engine_kinematics import IkAnswer, IkSettings, solve_ik
from .franka import KP_BASELINE, KV_BASELINE, per_joint
from .joints import JointMap, to_numpy
from .kinematics import ARM, DOWN

# Outer steps of the phases of a lift.
PHASES = {
    "approach": 100,
    "descend": 100,
    "settle": 20,
    "close": 60,
    "lift": 100,
    "hold": 100,
}

# The state at the end of each phase.
ENDS = dict(zip(PHASES, np.cumsum([*PHASES.values()]).tolist(), strict=True))

# Distance of the grip from the object's top, and of the hand's origin from the grip,
# which is 0.5 mm below the middle of the pads [m].
PAD, HAND_TO_PAD = 0.025, 0.1034

# Heights of the pregrasp above the grasp, and of the lift [m].
ABOVE, RISE = 0.10, 0.05

# Gains of the robot, with which fingers that close on 50 mm press with 12 N.
KP = per_joint(*KP_BASELINE[:7], 480, 480)
KV = per_joint(*KV_BASELINE[:7], 20, 20)

FINGERS = {"left": "left_finger", "right": "right_finger"}


def waypoints(place: Sequence[float], height: float) -> list[FloatArray]:
    """Return positions (3,) of the hand [m]: pregrasp, grasp and lifted, for an object's height."""
    x, y, z = place
    grasp = z + height - PAD + HAND_TO_PAD
    return [np.array([x, y, grasp + more]) for more in (ABOVE, 0.0, RISE)]


def ask(
    robot: Any,
    joints: JointMap,
    q_start: FloatArray,
    settings: IkSettings,
    points: Iterable[FloatArray],
) -> list[IkAnswer]:
    """Ask for each position of the hand, from the answer before; the fingers stay as at the start.

    Arrays have a row for each environment, and no such axis in a scene without.

    Args:
        robot: its entity.
        joints: all its joints.
        q_start: (…, d) start of the first search [rad or m].
        settings: of the solver.
        points: (…, 3) each [m].
    """
    answers, q = [], q_start
    down = np.broadcast_to(DOWN, (*q.shape[:-1], 4))
    for position in points:
        found = solve_ik(robot, joints, position, down, q, settings)
        q = np.concatenate(
            [found.q[..., :ARM].astype(float), q_start[..., ARM:]], axis=-1
        )
        answers.append(IkAnswer(q, found.error))
    return answers


def touches(robot: Any, joints: JointMap, fixed: Iterable[Any], q: FloatArray) -> int:
    """Return how often a robot touches entities or itself at joint positions (d,), without a step.

    This assigns the state.
    """
    robot.set_dofs_position(np.array(q), joints.dofs, zero_velocity=True)
    own = {geom.idx for geom in robot.geoms}
    others = {geom.idx for entity in fixed for geom in entity.geoms}
    pairs = np.reshape(robot.detect_collision(), (-1, 2)).tolist()
    return sum({a, b} <= own or not others.isdisjoint((a, b)) for a, b in pairs)


def line(ends: Sequence[FloatArray]) -> list[FloatArray]:
    """Return 11 joint positions on each straight line between ends, with both of its ends."""
    return [a + u * (b - a) for a, b in pairwise(ends) for u in np.linspace(0, 1, 11)]


def lift_command(q_start: FloatArray, answers: Sequence[IkAnswer]) -> FloatArray:
    """Return the command (n, d) of a lift: a straight line of joint positions in each phase.

    The fingers are commanded to their closed position at once, and the object stops
    them.
    """
    over, at, up = (answer.q for answer in answers)
    shut, raised = at.copy(), up.copy()
    shut[ARM:] = raised[ARM:] = 0
    ends = [q_start, over, at, at, shut, raised, raised]
    ways = zip(pairwise(ends), PHASES.items(), strict=True)
    return np.vstack(
        [
            np.tile(b, (n, 1)) if phase == "close" else np.linspace(a, b, n + 1)[1:]
            for (a, b), (phase, n) in ways
        ]
    )


def contact_counter(
    robot: Any, body: Any
) -> tuple[dict[str, int], Callable[[int], None]]:
    """Return counts of contacts of a body with the robot, and what updates them after each step.

    `descending` are the steps with a contact before the fingers close; `closed_left`
    and so on are the contact points of a finger after closing, `held_left` those at the
    end.
    """
    counts = {"descending": 0}
    reads = {ENDS["close"] - 1: "closed", ENDS["hold"] - 1: "held"}

    def after(step: int) -> None:
        descends = step < ENDS["settle"]
        if not descends and step not in reads:
            return
        contacts = body.get_contacts(with_entity=robot)
        geoms = np.concatenate([to_numpy(contacts[of]) for of in ("geom_a", "geom_b")])
        if descends:
            counts["descending"] += len(geoms) > 0
            return
        for side, name in FINGERS.items():
            link = robot.get_link(name)
            mine = (geoms >= link.geom_start) & (geoms < link.geom_end)
            counts[f"{reads[step]}_{side}"] = int(mine.sum())

    return counts, after
