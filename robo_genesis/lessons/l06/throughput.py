"""Throughput of batched scenes: how it is measured, and a model of the time of a step."""

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.experiment import Readings, counts
from robo_genesis.sim.franka import Q_START
from robo_genesis.sim.joints import to_numpy
from robo_genesis.sim.memory import used_memory

GROUP, EQUAL = "throughput", "rows_that_differ"
"""Groups of a bundle's metrics: elapsed times and memory of each number of environments, and how
many environments ended in another state than the first."""

UNITS = {"build": "s", "step": "s", "fastest": "s", "slowest": "s", "memory": "MiB"}
"""What is kept of each number of environments; `step` is the median over the repeats."""

KEPT = {"step": np.median, "fastest": np.min, "slowest": np.max}
"""What is kept of the repeats."""

RAISED = 0.1
"""Angle by which the timed command turns each arm joint from its start [rad]."""

Call = Callable[[], Any]
Clock = Callable[[], float]


@dataclass(frozen=True, slots=True)
class Protocol:
    """What is timed.

    `sizes` are numbers of environments, in the order in which their scenes are built. Each scene
    makes `warm_up` steps whose time is not used. Then each makes `steps` steps, in turn, and all
    of that is done `repeats` times. `others` are names of further scenes that are timed with them.
    """

    sizes: tuple[int, ...]
    others: tuple[str, ...] = ()
    warm_up: int = 10
    steps: int = 20
    repeats: int = 7

    def parameters(self) -> dict[str, Any]:
        """Return every configured input as JSON values, for the evidence key."""
        lists = {"sizes": list(self.sizes), "others": list(self.others)}
        return {"throughput": asdict(self) | lists | {"raised": RAISED}}

    def readings(self) -> dict[str, Readings]:
        """Return the groups of readings. No check judges a time."""
        units = {f"{name}_{size}": unit for size in self.sizes for name, unit in UNITS.items()}
        units |= {f"{name}_{other}": "s" for other in self.others for name in KEPT}
        return {GROUP: Readings(units, "performance"), EQUAL: counts(map(str, self.sizes))}


PROTOCOL = Protocol((1, 4, 16, 64, 256, 1024))
DEEPER = Protocol((1, 4, 16, 64, 256, 512, 1024), ("sphere_1", "sphere_256", "four_scenes"))
"""The same with one more size; with a sphere in place of the robot, and with four scenes of 256
environments in place of one of 1024."""

FITTED = (1, 16, 64)
"""Numbers of environments from which the model is fitted. It predicts the others."""


def seconds_per_step(step: Call, finish: Call, steps: int, clock: Clock) -> float:
    """Return the mean time of a step over some steps [s].

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


def in_turn(
    timed: Mapping[str, tuple[Call, Call]], protocol: Protocol, clock: Clock
) -> dict[str, float]:
    """Time several scenes in turn, so that a slow second of the machine touches all of them.

    Args:
        timed: `step` and `finish` of each scene by name, see `seconds_per_step`.
        protocol: what is timed.
        clock: returns a time [s].

    Returns:
        Median, fastest and slowest of the repeats: `step_NAME`, `fastest_NAME`, `slowest_NAME` [s].
    """
    for calls in timed.values():
        seconds_per_step(*calls, protocol.warm_up, clock)
    times: dict[str, list[float]] = {name: [] for name in timed}
    for _ in range(protocol.repeats):
        for name, calls in timed.items():
            times[name].append(seconds_per_step(*calls, protocol.steps, clock))
    return {f"{what}_{n}": float(of(t)) for n, t in times.items() for what, of in KEPT.items()}


def calls_of(scene: Any, robot: Any) -> tuple[Call, Call]:
    """Return how to start a step of a scene, and how to wait for all started ones."""
    return scene.step, lambda: to_numpy(robot.get_dofs_position())


def start(robot: Any) -> None:
    """Bring the arms of all environments to the course's start, and command a small motion."""
    shape = to_numpy(robot.get_dofs_position()).shape
    robot.set_dofs_position(np.broadcast_to(Q_START, shape).copy(), zero_velocity=True)
    robot.control_dofs_position(np.broadcast_to(Q_START + RAISED, shape)[..., :7].copy(), range(7))


def measure(
    build: Callable[[int], tuple[Any, ...]],
    protocol: Protocol = PROTOCOL,
    clock: Clock = time.perf_counter,
    memory: Callable[[], float] = used_memory,
    others: Callable[[Mapping[int, Any]], Mapping[str, tuple[Call, Call]]] = lambda built: {},
) -> tuple[dict[str, float], dict[str, int]]:
    """Time building and stepping of a scene for each number of environments.

    All scenes exist at the same time.

    Args:
        build: returns a built scene with so many environments, its robot, and what else it has.
        protocol: what is timed.
        clock: returns a time [s].
        memory: returns the memory in use [MiB].
        others: returns `step` and `finish` of further scenes, given scene and robot of each size.

    Returns:
        Both groups of readings.
    """
    found: dict[str, float] = {}
    built: dict[int, tuple[Any, Any]] = {}
    for size in protocol.sizes:
        before, begin = memory(), clock()
        scene, robot, *_ = build(size)
        built[size] = scene, robot
        found[f"build_{size}"] = clock() - begin
        start(robot)
        calls_of(scene, robot)[1]()
        found[f"memory_{size}"] = memory() - before
    timed = {str(size): calls_of(*of) for size, of in built.items()}
    found |= in_turn(timed | dict(others(built)), protocol, clock)
    ends = {str(size): to_numpy(robot.get_dofs_position()) for size, (_, robot) in built.items()}
    return found, {name: int((q != q[0]).any(axis=1).sum()) for name, q in ends.items()}


def explanations(
    built: Mapping[int, Any], build: Callable[[int], tuple[Any, ...]],
    build_sphere: Callable[[int], tuple[Any, ...]],
) -> dict[str, tuple[Call, Call]]:  # fmt: skip
    """Return the other scenes of `DEEPER`, given scene and robot of each size."""
    four = [calls_of(*built[256])]
    for _ in range(3):
        scene, robot, *_ = build(256)
        start(robot)
        four.append(calls_of(scene, robot))
    spheres = {f"sphere_{size}": calls_of(*build_sphere(size)[:2]) for size in (1, 256)}
    step, finish = (lambda k=k: [calls[k]() for calls in four] for k in (0, 1))
    return spheres | {"four_scenes": (step, finish)}


def sizes_of(found: Mapping[str, float]) -> list[int]:
    """Return the numbers of environments of a group of readings."""
    return [int(name.removeprefix("build_")) for name in found if name.startswith("build_")]


def column(found: Mapping[str, float], name: str) -> FloatArray:
    """Return one kind of reading for each number of environments."""
    return np.array([found[f"{name}_{size}"] for size in sizes_of(found)])


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


def fit(sizes: Any, times: Any) -> Model:
    """Return the model with the least squares of relative errors.

    Args:
        sizes: numbers of environments (n,), at least two different ones.
        times: of one step (n,) [s].
    """
    sizes, times = np.asarray(sizes, float), np.asarray(times, float)
    columns = np.stack([1 / times, sizes / times], axis=1)  # (n, 2)
    fixed, each = np.linalg.lstsq(columns, np.ones(len(times)), rcond=None)[0]
    return Model(float(fixed), float(each))
