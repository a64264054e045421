"""An expert that answers where the clones go, and what its answers add to the rows."""

from collections.abc import Callable

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.picking import CLOSE, PickCase

from .cloning import Acting, Clones, Rows, stacked
from .experts import Looking, looked

MOVED = 1e-3  # Distance from which an object is at another place [m]

# Solves postures for places (e, 2): goals and whether they are accepted, as `picking.plan`.
Solve = Callable[[FloatArray], tuple[FloatArray, np.ndarray]]


class Asking(Acting):
    """Clones that act, while an expert answers what it would command.

    The postures of the expert are solved for the place where the object began. Where the
    object is elsewhere they are solved again, from the same start of the search: `always`,
    or only while the object is not in the hand or in the bowl. Answers count where the
    solver accepts the postures.
    """

    def __init__(
        self,
        clones: Clones,
        solve: Solve,
        always: bool,
        case: PickCase,
        goals: FloatArray,
        accepted: np.ndarray,
    ) -> None:
        super().__init__(clones, case, goals, accepted)
        self.expert = Looking(case, goals.copy(), accepted)
        self.solve, self.always = solve, always
        self.solved = np.array(case.beliefs)
        self.accepted = accepted.copy()
        self.answers: list[FloatArray] = []
        self.known: list[np.ndarray] = []

    def act(self, q: FloatArray, qd: FloatArray, pose: FloatArray) -> FloatArray:
        """Return the clones' next command (e, 9), and keep the expert's answer."""
        expert, place = self.expert, pose[:, :2].astype(float)
        moved = np.linalg.norm(place - self.solved, axis=1) > MOVED
        moved &= self.always | (looked(expert.case, q, pose) <= CLOSE)
        if moved.any():
            goals, accepted = self.solve(place)
            expert.goals[:, moved] = goals[:, moved]
            self.accepted[moved], self.solved[moved] = accepted[moved], place[moved]
        expert.command = self.last.copy()
        self.answers.append(expert.act(q, qd, pose).copy())
        self.known.append(self.accepted.copy())
        return super().act(q, qd, pose)

    def rows(self) -> Rows:
        """Return the answers as rows."""
        answers = np.stack(self.answers, dtype=np.float32)
        return Rows(stacked(self.seen), answers, np.stack(self.known))
