"""Clones: networks that learn the rows of an expert's episodes, and act in its place."""

import hashlib
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.arm.picking import DONE, PHASES, PickCase

from .experts import KINDS
from .settings import INPUTS, Training

LEAST = 1e-6  # Smallest spread of an output by which it is divided [rad or m]

EVERY = 100  # Steps of the optimiser between two values of the loss

AFTER = 10  # Rows of an episode after its last phase that are learned


class Rows(NamedTuple):
    """Samples of episodes: what is seen, by name of the input (n, e, …), and what follows.

    `command` (n, e, 9) is the next command of the expert [rad or m], and `used` (n, e)
    says which rows are learned.
    """

    seen: dict[str, FloatArray]
    command: FloatArray
    used: np.ndarray

    def of(self, episodes: slice) -> "Rows":
        """Return the rows of some episodes."""
        seen = {name: values[:, episodes] for name, values in self.seen.items()}
        return Rows(seen, self.command[:, episodes], self.used[:, episodes])


def seen(
    q: FloatArray, pose: FloatArray, phase: np.ndarray, last: FloatArray
) -> dict[str, FloatArray]:
    """Return by name what a network can be given; `pose` (…, 7) is that of the object."""
    of_phase = np.eye(len(PHASES))[phase]
    values = q, pose[..., :3], pose[..., 3:], of_phase, last
    return {
        name: of.astype(np.float32) for name, of in zip(INPUTS, values, strict=True)
    }


def stacked(samples: list[dict[str, FloatArray]]) -> dict[str, FloatArray]:
    """Return samples by name, with the axis of time first."""
    return {name: np.stack([of[name] for of in samples]) for name in INPUTS}


def joined(rows: Rows, other: Rows) -> Rows:
    """Return the episodes of both."""
    parts = {n: np.hstack([of, other.seen[n]]) for n, of in rows.seen.items()}
    command, used = (np.hstack(of) for of in zip(rows[1:], other[1:], strict=True))
    return Rows(parts, command, used)


def chunks(command: FloatArray, length: int) -> FloatArray:
    """Return for each row (n, e, 9) the next commands (n, e, length, 9); the last one stays."""
    ahead = np.arange(len(command))[:, None] + np.arange(length)
    return np.moveaxis(command[np.minimum(ahead, len(command) - 1)], 1, 2)


@dataclass(frozen=True)
class Scale:
    """Mean and spread of the columns of an array, which it removes and restores."""

    mean: FloatArray
    spread: FloatArray

    @classmethod
    def of(cls, values: FloatArray, least: float) -> "Scale":
        """Return those of rows (m, …); no spread is smaller than `least`."""
        exact = values.astype(np.float64)
        return cls(exact.mean(axis=0), np.maximum(exact.std(axis=0), least))

    def without(self, values: FloatArray) -> FloatArray:
        """Return values with mean 0 and spread 1."""
        scaled = (values - self.mean) / self.spread
        return scaled.astype(np.float32)

    def restored(self, values: FloatArray) -> FloatArray:
        """Return values from those without."""
        return values * self.spread + self.mean


class Clones:
    """The networks of one kind, which learn the same rows."""

    def __init__(self, training: Training, rows: Rows) -> None:
        """Train the networks on the rows that are used; on one thread, equal to the bit.

        `losses` (steps / 100, networks) are mean squared errors of scaled outputs, each the
        mean of 100 steps.
        """
        self.training = training
        inputs = self.inputs(rows.seen)[rows.used]
        outputs = chunks(rows.command, training.chunk) - self.offset(rows.seen)
        outputs = outputs[rows.used].reshape(len(inputs), -1)
        self.given, self.made = (
            Scale.of(inputs, training.least),
            Scale.of(outputs, LEAST),
        )
        self.losses, self.layers = fit(
            training, self.given.without(inputs), self.made.without(outputs)
        )

    def inputs(self, seen: dict[str, FloatArray]) -> FloatArray:
        """Return the inputs of this kind (…, f)."""
        return np.concatenate([seen[name] for name in self.training.inputs], axis=-1)

    def offset(self, seen: dict[str, FloatArray]) -> FloatArray:
        """Return what is added to outputs (…, 1, 9): the arm's position, or zero."""
        arm = np.arange(seen["q"].shape[-1]) < ARM
        return (seen["q"] * arm * self.training.difference)[..., None, :]

    def outputs(self, seen: dict[str, FloatArray]) -> FloatArray:
        """Return scaled outputs (e, chunk, 9); each network answers for its part of rows e."""
        inputs, n = self.given.without(self.inputs(seen)), self.training.networks
        found = forward(self.layers, inputs.reshape(n, -1, inputs.shape[1]))
        return found.reshape(len(inputs), self.training.chunk, -1)

    def __call__(self, seen: dict[str, FloatArray]) -> FloatArray:
        """Return the next commands (e, chunk, 9) [rad or m]."""
        outputs = self.outputs(seen)
        flat = self.made.restored(outputs.reshape(len(outputs), -1))
        return flat.reshape(outputs.shape) + self.offset(seen)

    def errors(self, rows: Rows) -> FloatArray:
        """Return the median error of an arm's joint by network, in rows of other episodes [rad]."""
        every = {name: of[rows.used] for name, of in rows.seen.items()}
        n = self.training.networks
        all_networks = {name: np.tile(of, (n, 1)) for name, of in every.items()}
        found = self(all_networks)[:, 0, :ARM].reshape(n, -1, ARM)
        return np.median(np.abs(found - rows.command[rows.used][:, :ARM]), axis=(1, 2))

    def digests(self) -> np.ndarray:
        """Return a number of each network that changes with any bit of its weights."""
        parts = [
            b"".join(layer[k].tobytes() for pair in self.layers for layer in pair)
            for k in range(self.training.networks)
        ]
        return np.array([int(hashlib.sha256(of).hexdigest()[:12], 16) for of in parts])


Layers = list[tuple[np.ndarray, np.ndarray]]


def forward(layers: Layers, values: FloatArray) -> FloatArray:
    """Return the outputs (networks, k, out) of inputs (networks, k, in)."""
    for weights, bias in layers[:-1]:
        values = np.maximum(values @ weights + bias, 0)
    weights, bias = layers[-1]
    return values @ weights + bias


def fit(
    training: Training, inputs: FloatArray, outputs: FloatArray
) -> tuple[FloatArray, Layers]:
    """Return losses and layers of networks that learn outputs (m, out) from inputs (m, in)."""
    import torch

    if training.steps % EVERY:
        raise ValueError(f"steps is {training.steps}; give a multiple of {EVERY}.")
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    first, n = training.seed, training.networks
    random = [torch.Generator().manual_seed(first + k) for k in range(n)]
    sizes = [inputs.shape[1], *[training.width] * 3, outputs.shape[1]]
    layers: list[list[Any]] = []
    for a, b in pairwise(sizes):
        shares = torch.stack([torch.rand(a + 1, b, generator=of) for of in random])
        start = (2 * shares - 1) / a**0.5
        layers.append([start[:, :a].clone(), start[:, a:].clone()])
    values = [of.requires_grad_() for layer in layers for of in layer]
    optimiser = torch.optim.Adam(values, lr=2e-3)
    slower = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, training.steps)
    given, made = torch.from_numpy(inputs), torch.from_numpy(outputs)
    losses = []
    for _ in range(training.steps):
        shape = (training.batch,)
        rows = torch.stack(
            [torch.randint(len(given), shape, generator=of) for of in random]
        )
        x = given[rows]
        for weights, bias in layers[:-1]:
            x = torch.relu(torch.baddbmm(bias, x, weights))
        weights, bias = layers[-1]
        apart = torch.baddbmm(bias, x, weights) - made[rows]
        loss = (apart**2).mean(dim=(1, 2))
        optimiser.zero_grad()
        loss.sum().backward()
        optimiser.step()
        slower.step()
        losses.append(loss.detach())
    torch.set_num_threads(threads)
    found = torch.stack(losses).numpy().reshape(-1, EVERY, n).mean(axis=1)
    return found, [(w.detach().numpy(), b.detach().numpy()) for w, b in layers]


class Showing:
    """An expert whose commands are rows, and are executed with noise; see `picking.run`."""

    def __init__(
        self,
        training: Training,
        case: PickCase,
        goals: FloatArray,
        accepted: np.ndarray,
    ) -> None:
        self.expert = KINDS[training.expert](case, goals, accepted)
        self.noise = training.noise
        self.random = np.random.default_rng(training.seed)
        self.last = self.expert.command.copy()
        self.seen: list[dict[str, FloatArray]] = []
        self.commands: list[FloatArray] = []

    @property
    def phase(self) -> np.ndarray:
        """The phases (e,) of the expert."""
        return self.expert.phase

    def act(self, q: FloatArray, qd: FloatArray, pose: FloatArray) -> FloatArray:
        """Return what is executed (e, 9), and keep what the expert saw and commanded."""
        command = self.expert.act(q, qd, pose).copy()
        self.seen.append(seen(q, pose, self.phase, self.last))
        self.commands.append(command)
        self.last = command
        arm = np.arange(command.shape[1]) < ARM
        return command + arm * self.random.normal(0, self.noise, command.shape)

    def rows(self) -> Rows:
        """Return the rows of all episodes; of those after the last phase, `AFTER` are used."""
        every = stacked(self.seen)
        done = (every["phase"].argmax(axis=2) == DONE).cumsum(axis=0)
        return Rows(every, np.stack(self.commands, dtype=np.float32), done <= AFTER)


class Acting:
    """Clones that act in the place of an expert; see `picking.run`.

    A machine of this expert beside them, whose commands nothing follows, has the phase.
    Fingers are commanded to be open or shut, whichever the output is nearer to.
    """

    def __init__(
        self, clones: Clones, case: PickCase, goals: FloatArray, accepted: np.ndarray
    ) -> None:
        self.clones = clones
        self.beside = KINDS[clones.training.expert](case, goals, accepted)
        self.last = self.beside.command.copy()
        self.seen: list[dict[str, FloatArray]] = []
        self.ahead: FloatArray = np.zeros((len(accepted), 0, self.last.shape[1]))
        self.opened = float(case.q_start[-1])

    @property
    def phase(self) -> np.ndarray:
        """The phases (e,) of the machine beside them."""
        return self.beside.phase

    def act(self, q: FloatArray, qd: FloatArray, pose: FloatArray) -> FloatArray:
        """Return the next command (e, 9), as `picking.Expert.act` does."""
        self.beside.act(q, qd, pose)
        self.seen.append(seen(q, pose, self.phase, self.last))
        if not self.ahead.shape[1]:
            self.ahead = self.clones(self.seen[-1])
        command, self.ahead = self.ahead[:, 0].astype(float), self.ahead[:, 1:]
        command[:, ARM:] = np.where(command[:, ARM:] < self.opened / 2, 0, self.opened)
        self.last = command
        return command
