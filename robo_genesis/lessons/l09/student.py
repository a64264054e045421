"""Clones of L09's lab that are made of a student's functions."""

from collections.abc import Callable
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Demonstrations

from . import spec
from .cloning import LEAST, Clones, Rows, Scale, fit
from .settings import Training

Written = Callable[..., Any]  # A function that a student wrote


def learned(pairs: Written, shown: Demonstrations, rows: Rows) -> tuple[Any, Any, Any]:
    """Return rows of all demonstrations by a student's function, and which of them are learned.

    Returns:
        What was seen (m, 16), the next commands (m, 9), and whether a row is learned (m,).
    """
    pose = np.concatenate([shown.object_pos, shown.object_quat], axis=2)
    found, episodes = [], shown.q.shape[1]
    for k in range(episodes):
        x, y = pairs(shown.q[:, k], pose[:, k], shown.target[:, k])
        found.append((x[rows.used[:, k]], y[rows.used[:, k]]))
    x, y = (np.float32(np.concatenate(parts)) for parts in zip(*found, strict=True))
    count = np.repeat(np.arange(episodes), [len(one) for one, _ in found])
    return x, y, count < spec.LOOKING.demonstrations


def flat(rows: Rows) -> tuple[FloatArray, FloatArray, np.ndarray]:
    """Return what was seen (m, 16), the commands (m, 9) and which are used (m,), of all samples."""
    seen = np.concatenate([rows.seen[name] for name in ("q", "place", "turn")], axis=2)
    return seen.reshape(-1, 16), rows.command.reshape(-1, 9), rows.used.ravel()


class Own(Clones):
    """Clones that learn a student's rows, scaled and turned into commands by a student.

    Args:
        training: the settings; one command for each output, and no phase or last command.
        x: what was seen (m, 16).
        y: the next commands (m, 9).
        used: which rows are learned (m,).
        scale: the student's function.
        command: the student's function.
    """

    def __init__(
        self,
        training: Training,
        x: FloatArray,
        y: FloatArray,
        used: np.ndarray,
        scale: Written,
        command: Written,
    ) -> None:
        self.training, self.command = training, command
        q, place, turn = x[:, :9], x[:, 9:12], x[:, 12:]
        seen = {"q": q, "place": place, "turn": turn}
        inputs = self.inputs(seen)
        outputs = (y[:, None] - self.offset(seen)).reshape(len(x), -1)
        self.given = Scale(*scale(inputs, used, training.least))
        self.made = Scale(*scale(outputs, used, LEAST))
        self.losses, self.layers = fit(
            training,
            self.given.without(inputs)[used],
            self.made.without(outputs)[used],
        )

    def __call__(self, seen: dict[str, FloatArray]) -> FloatArray:
        """Return the next commands (e, 1, 9) by the student's function."""
        outputs, offset = self.outputs(seen)[:, 0], self.offset(seen)[:, 0, :7]
        made = self.made
        return np.asarray(self.command(outputs, made.mean, made.spread, offset))[
            :, None
        ]
