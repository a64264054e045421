"""Experts for one task. They differ in when they wait, and in what they remember."""

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.kinematics import ARM, hand_pose, rotate
from robo_genesis.sim.arm.lifting import HAND_TO_PAD
from robo_genesis.sim.arm.picking import PHASES, PickCase

PREGRASP, DESCEND, CLOSE, LIFT, MOVE, LOWER, OPEN, RETREAT, _ = range(len(PHASES))

# A joint of a prompt expert is near its goal [rad], its fingers are shut or open [m].
NEAR, SHUT, WIDE = 0.03, 0.03, 0.035

STAY = 5  # Commands that an expert waits at each goal

# What an expert without memory sees [m]: the object is between shut fingers, in the bowl
# and low, over it; the pads are high, or at the object.
HELD, INSIDE, LOW, OVER, HIGH, AT = 0.03, 0.06, 0.06, 0.02, 0.115, 0.012


class Prompt(picking.Expert):
    """L08's phase machine, which goes on as soon as it is near a goal, without waiting for rest."""

    def ends(self, q: FloatArray, qd: FloatArray) -> np.ndarray:
        """Return in which environments (e,) the present phase has reached its end."""
        way = q[:, :ARM] - self.goals[self.phase, self.rows]
        near, fingers = np.abs(way).max(axis=1) < NEAR, q[:, ARM:]
        shut, wide = fingers.max(axis=1) < SHUT, fingers.min(axis=1) > WIDE
        of_close, of_open = self.phase == CLOSE, self.phase == OPEN
        return np.where(of_close, shut, np.where(of_open, wide, near))


class Delayed(Prompt):
    """The prompt expert, which stays at each goal for a while."""

    def __init__(self, case: PickCase, goals: FloatArray, accepted: np.ndarray) -> None:
        super().__init__(case, goals, accepted)
        self.stayed = np.zeros(len(accepted), int)

    def ends(self, q: FloatArray, qd: FloatArray) -> np.ndarray:
        """Return in which environments (e,) the present phase has ended `STAY` commands ago."""
        self.stayed = np.where(super().ends(q, qd), self.stayed + 1, 0)
        ended = self.stayed > STAY
        self.stayed[ended] = 0
        return ended


class Looking(Prompt):
    """An expert whose phase follows from what it sees; it remembers its last command alone."""

    def __init__(self, case: PickCase, goals: FloatArray, accepted: np.ndarray) -> None:
        super().__init__(case, goals, accepted)
        self.case = case

    def act(
        self, q: FloatArray, qd: FloatArray, pose: FloatArray | None = None
    ) -> FloatArray:
        """Return the next command (e, 9) of the phase that joints and object show."""
        assert pose is not None
        self.phase, self.since[:] = looked(self.case, q, pose), 0
        return super().act(q, qd, pose)

    def ends(self, q: FloatArray, qd: FloatArray) -> np.ndarray:
        """Return that no phase (e,) ends: each follows from what is seen next."""
        return np.zeros(len(q), bool)


def looked(case: PickCase, q: FloatArray, pose: FloatArray) -> np.ndarray:
    """Return the phase (e,) that positions (e, 9) and the object's pose (e, 7) show."""
    hand, place = hand_pose(q), pose[:, :3]
    pads = hand.position + rotate(hand.quat, np.array([0.0, 0.0, HAND_TO_PAD]))
    aside = np.linalg.norm((pads - place)[:, :2], axis=1)
    above, height = pads[:, 2] - place[:, 2], case.size[2] / 2 - case.pad
    shut = q[:, ARM:].max(axis=1) < SHUT
    held = shut & (aside < HELD) & (np.abs(above) < HELD)
    to_bowl = np.linalg.norm(place[:, :2] - case.bowl_at, axis=1)
    placed = (to_bowl < INSIDE) & (place[:, 2] < LOW)
    over, high = to_bowl < OVER, pads[:, 2] > HIGH
    near = aside < AT
    seen = {
        OPEN: placed & shut,
        RETREAT: placed,
        LOWER: held & over,
        MOVE: held & high,
        LIFT: held,
        CLOSE: near & (above < height + AT),
        DESCEND: near,
    }
    return np.select([*seen.values()], [*seen], PREGRASP)


KINDS = {
    "waiting": picking.Expert,
    "prompt": Prompt,
    "delayed": Delayed,
    "looking": Looking,
}
