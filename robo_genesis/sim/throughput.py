"""Elapsed time of the steps of some scenes with a simple model of it, and the memory in use."""

import gc
import importlib
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .arm.joints import to_numpy

MIB = 2**20  # Bytes of one MiB

# On an accelerator, the first call returns before the step is done.
# The first call starts a step. The second returns when all started steps are done.
Calls = tuple[Callable[[], Any], Callable[[], Any]]

Clock = Callable[[], float]

# What is kept of the repeats.
KEPT: dict[str, Callable[..., Any]] = {
    "step": np.median,
    "fastest": np.min,
    "slowest": np.max,
}


def calls_of(scene: Any, robot: Any) -> Calls:
    """Return how to start a step of a scene, and how to wait for it: by reading the state."""
    return scene.step, lambda: to_numpy(robot.get_dofs_position())


def together(scenes: Sequence[Calls]) -> Calls:
    """Return calls that step all scenes, and wait for all."""
    return lambda: [step() for step, _ in scenes], lambda: [
        finish() for _, finish in scenes
    ]


def seconds_per_step(calls: Calls, steps: int, clock: Clock) -> float:
    """Return the mean time of a step over some steps [s]."""
    step, finish = calls
    finish()
    begin = clock()
    for _ in range(steps):
        step()
    finish()
    return (clock() - begin) / steps


def in_turn(
    timed: Mapping[str, Calls], warm_up: int, steps: int, repeats: int, clock: Clock
) -> dict[str, float]:
    """Time several scenes in turn, so that a slow second of the machine touches all of them.

    Each repeat has an order of its own, so that no scene always follows the same other
    one.

    Args:
        timed: calls of each scene by name.
        warm_up: steps of each scene before each repeat, whose time is not used: the
            scene before has filled the processor's cache with its own data.
        steps: of each scene in one repeat.
        repeats: their number.
        clock: returns a time [s].

    Returns:
        Median, fastest and slowest of the repeats: `step_NAME`, `fastest_NAME`,
            `slowest_NAME` [s].
    """

    def one(calls: Calls) -> float:
        seconds_per_step(calls, warm_up, clock)
        return seconds_per_step(calls, steps, clock)

    shuffled = np.random.default_rng(0)
    orders = [shuffled.permutation([*timed]).tolist() for _ in range(repeats)]
    times = [{name: one(timed[name]) for name in order} for order in orders]
    return {
        f"{what}_{name}": float(of([repeat[name] for repeat in times]))
        for name in timed
        for what, of in KEPT.items()
    }


def used_memory() -> float:
    """Return the memory in use [MiB]: of this process, on an accelerator of the whole device."""
    gc.collect()
    torch = importlib.import_module("torch")
    # The name in ROCm as well; not initialized if the engine runs on the CPU.
    if torch.cuda.is_initialized():
        free, total = torch.cuda.mem_get_info()
        return float((total - free) / MIB)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE") / MIB


class Model(NamedTuple):
    """The time of one step of B environments: `fixed` + B · `each` [s]."""

    fixed: float
    each: float

    def step_time(self, size: Any) -> Any:
        """Return the time of one step of so many environments [s]."""
        return self.fixed + self.each * size


def fit(sizes: Any, times: Any) -> Model:
    """Return the model with the least squares of relative errors.

    Args:
        sizes: numbers of environments (n,), at least two different ones.
        times: of one step (n,) [s].
    """
    each, fixed = np.polyfit(sizes, times, 1, w=1 / np.asarray(times))
    return Model(float(fixed), float(each))
