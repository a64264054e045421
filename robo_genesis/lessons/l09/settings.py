"""The settings of one kind of clones, and the starts of episodes."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.scene import FloatArray, read_only

# Inputs of a network and their numbers: positions of all joints, place and orientation of
# the object, the phase of the expert beside it, the last command.
INPUTS = {"q": 9, "place": 3, "turn": 4, "phase": 9, "last": 9}


@dataclass(frozen=True, slots=True, kw_only=True)
class Training:
    """How one kind of clones is trained: networks that differ in their seeds alone.

    | field | meaning |
    |---|---|
    | `expert` | its name in `experts.KINDS` |
    | `demonstrations` | number of its episodes |
    | `inputs` | names of `INPUTS` |
    | `difference` | whether the output is the command minus the position, for the arm |
    | `chunk` | number of commands that one output has, all of which are executed |
    | `noise` | standard deviation of what is added to commands that are executed [rad] |
    | `least` | smallest spread by which an input is divided [rad or m] |
    | `answers` | of an expert about 16 episodes of clones: none, or with postures that are |
    | | solved again `always` or only for an object that lies `elsewhere` |
    | `steps` | of the optimiser, in each of which a network sees `batch` rows |
    | `networks` | their number, each with `width` units in three layers |
    | `seed` | of the first network |
    """

    expert: str = "prompt"
    demonstrations: int = 64
    inputs: tuple[str, ...] = ("q", "place", "turn")
    difference: bool = False
    chunk: int = 1
    noise: float = 0.0
    least: float = 1e-6
    answers: str = ""
    steps: int = 2000
    batch: int = 256
    networks: int = 8
    width: int = 128
    seed: int = 0


def spread(count: int, seed: int, least: FloatArray, most: FloatArray) -> FloatArray:
    """Return places (count, 2) at random, one in each of `count` rows and columns [m]."""
    rng = np.random.default_rng(seed)
    order = np.column_stack([rng.permutation(count) for _ in range(2)])
    return read_only(least + (order + rng.random((count, 2))) / count * (most - least))
