"""Throughput of batched scenes: how it is measured, and a model of the time of a step."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.experiment import Readings
from robo_genesis.sim.joints import to_numpy
from robo_genesis.sim.memory import used_memory

GROUP = "throughput"
"""Group of a bundle's metrics: elapsed times and memory of each number of environments."""

Call = Callable[[], Any]


@dataclass(frozen=True, slots=True)
class Protocol:
    """What is timed.

    `sizes` are numbers of environments, in the order in which their scenes are built. Each scene
    makes `warm_up` steps whose time is not used. Then each makes `steps` steps, in turn, and all
    of that is done `repeats` times.
    """

    sizes: tuple[int, ...]
    warm_up: int
    steps: int
    repeats: int


PROTOCOL = Protocol(sizes=(1, 4, 16, 64, 256, 1024), warm_up=20, steps=20, repeats=7)

UNITS = {
    "build": "s", "first_step": "s", "step": "s", "fastest": "s", "slowest": "s", "memory": "MiB",
}  # fmt: skip
"""What is kept of each size, with units; `step` is the median over the repeats."""


def seconds_per_step(step: Call, finish: Call, steps: int, clock: Callable[[], float]) -> float:
    """Return the mean time of one of some steps [s].

    Args:
        step: starts a step; on an accelerator it returns before the step is done.
        finish: returns when all started steps are done, such as a read of the state.
        steps: their number.
        clock: returns a time [s].
    """
    finish()
    begin = clock()
    for _ in range(steps):
        step()
    finish()
    return (clock() - begin) / steps


def measure(
    build: Callable[[int], tuple[Any, Any]],
    start: Callable[[Any, Any], Any],
    protocol: Protocol = PROTOCOL,
    clock: Callable[[], float] = time.perf_counter,
    memory: Callable[[], float] = used_memory,
) -> dict[str, float]:
    """Time building and stepping of a scene for each number of environments.

    All scenes exist at the same time, and each repeat visits all of them. So a slow minute of the
    machine touches every size.

    Args:
        build: returns a built scene with so many environments, and its robot.
        start: assigns the state and the command of all environments; its time is not used.
        protocol: what is timed.
        clock: returns a time [s].
        memory: returns the memory in use [MiB].

    Returns:
        The readings of the group, see `names`.
    """
    found: dict[str, float] = {}
    timed: dict[int, tuple[Call, Call]] = {}
    for size in protocol.sizes:
        before, begin = memory(), clock()
        scene, robot = build(size)
        found[f"build_{size}"] = clock() - begin
        start(scene, robot)
        calls = timed[size] = scene.step, lambda robot=robot: to_numpy(robot.get_dofs_position())
        found[f"first_step_{size}"] = seconds_per_step(*calls, 1, clock)
        seconds_per_step(*calls, protocol.warm_up, clock)
        found[f"memory_{size}"] = memory() - before
    repeats = [
        {size: seconds_per_step(*calls, protocol.steps, clock) for size, calls in timed.items()}
        for _ in range(protocol.repeats)
    ]
    for size in protocol.sizes:
        times = [repeat[size] for repeat in repeats]
        kept = float(np.median(times)), min(times), max(times)
        found |= dict(zip((f"{n}_{size}" for n in ("step", "fastest", "slowest")), kept))
    return found


def readings(protocol: Protocol = PROTOCOL) -> dict[str, Readings]:
    """Return the group of readings: no check judges them."""
    units = {f"{name}_{size}": unit for name, unit in UNITS.items() for size in protocol.sizes}
    return {GROUP: Readings(units, "performance")}


def column(found: Mapping[str, float], name: str, protocol: Protocol = PROTOCOL) -> FloatArray:
    """Return one kind of reading (sizes,)."""
    return np.array([found[f"{name}_{size}"] for size in protocol.sizes])


@dataclass(frozen=True, slots=True)
class Model:
    """The time of one step of B environments: `fixed` + B · `each` [s]."""

    fixed: float
    each: float

    def step_time(self, size: Any) -> Any:
        """Return the time of one step of so many environments [s]."""
        return self.fixed + self.each * np.asarray(size)

    @property
    def half(self) -> float:
        """The number of environments at half of the largest throughput, which is 1 / `each`."""
        return self.fixed / self.each


def fit(sizes: FloatArray, times: FloatArray) -> Model:
    """Return the model with the least squares of relative errors.

    Args:
        sizes: numbers of environments (n,), n ≥ 2.
        times: of one step (n,) [s].
    """
    sizes, times = np.asarray(sizes, float), np.asarray(times, float)
    columns = np.stack([1 / times, sizes / times], axis=1)  # (n, 2)
    fixed, each = np.linalg.lstsq(columns, np.ones(len(times)), rcond=None)[0]
    return Model(float(fixed), float(each))
