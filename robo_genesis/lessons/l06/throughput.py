"""Throughput of batches: the protocol of its measurement."""

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Readings, counts, json_value
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim import throughput as timing
from robo_genesis.sim.arm.franka import Q_START
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.throughput import Calls, Clock, calls_of

# Groups of a bundle's metrics: times and memory, and how many environments did other
# work.
GROUP, EQUAL = "throughput", "rows_that_differ"

# Angle by which the timed command turns each arm joint from its start [rad]
RAISED = 0.1

# Largest distance of an arm joint from its commanded angle at the end [rad], sag
# included.
NEAR = RAISED / 5

# Returns a built scene with so many environments, its robot, and what else it has.
Build = Callable[[int], tuple[Any, ...]]


@dataclass(frozen=True, slots=True)
class Protocol:
    """What is timed.

    `sizes` are numbers of environments, in the order in which their scenes are built.
    In a new order each time, each scene makes `warm_up` steps whose time is not used
    and `steps` steps, and all of that is done `repeats` times. `others` are names of
    further scenes that are timed too.
    """

    sizes: tuple[int, ...]
    others: tuple[str, ...] = ()
    warm_up: int = 10
    steps: int = 20
    repeats: int = 5

    def parameters(self) -> dict[str, Any]:
        """Return every configured input as JSON values, for the evidence key."""
        return {GROUP: json_value(asdict(self)) | {"raised": RAISED}}

    def readings(self) -> dict[str, Readings]:
        """Return the groups of readings."""
        names = [*map(str, self.sizes), *self.others]
        units = {f"{what}_{name}": "s" for name in names for what in timing.KEPT}
        for size in self.sizes:
            units |= {f"build_{size}": "s", f"memory_{size}": "MiB"}
        return {
            GROUP: Readings(units, "performance"),
            EQUAL: counts(map(str, self.sizes)),
        }


PROTOCOL = Protocol((1, 4, 16, 64, 256, 1024))

# Scenes that are timed with the sizes of `ENDS`, by content, and their substeps.
PARTS = {"sphere": 2, "robot_1": 1, "robot_4": 4}

# Numbers of environments from which both parts of a step are computed.
ENDS = (1, 64)

# Four scenes of a size that are stepped in turn.
FOUR = {"four_of_256": 256, "four_of_250": 250}

# The same with sizes beside powers of two, and with other scenes.
DEEPER = Protocol(
    (1, 4, 16, 60, 64, 250, 256, 1000, 1024),
    (*(f"{of}_{size}" for of in PARTS for size in ENDS), *FOUR),
)

# Numbers of environments from which the model is fitted, three at a time. It predicts
# others.
FITTED = (1, 16, 60, 64)


def start(robot: Any) -> None:
    """Bring the arms of all environments to the course's start, and command a small motion."""
    q = np.tile(Q_START, (robot.scene.n_envs, 1))
    robot.set_dofs_position(q, zero_velocity=True)
    robot.control_dofs_position(q[:, :ARM] + RAISED, range(ARM))


def unequal(q: FloatArray) -> int:
    """Return how many rows (B, 9) did not make the motion, or differ from the first row."""
    near = np.abs(q[:, :ARM] - Q_START[:ARM] - RAISED) <= NEAR
    return len(q) - int((near.all(axis=1) & (q == q[0]).all(axis=1)).sum())


def measure(
    build: Build,
    protocol: Protocol = PROTOCOL,
    clock: Clock = time.perf_counter,
    memory: Callable[[], float] = timing.used_memory,
    others: Mapping[str, Calls] = MappingProxyType({}),
) -> tuple[dict[str, float], dict[str, int]]:
    """Time building and stepping of a scene for each number of environments.

    Args:
        build: makes a scene; all of them exist at the same time.
        protocol: what is timed.
        clock: returns a time [s].
        memory: returns the memory in use [MiB].
        others: the further scenes.

    Returns:
        Both groups of readings.
    """
    found: dict[str, float] = {}
    built: dict[int, tuple[Any, Any]] = {}
    for size in protocol.sizes:
        before, begin = memory(), clock()
        scene, robot, *_ = build(size)
        found[f"build_{size}"] = clock() - begin
        start(robot)
        found[f"memory_{size}"] = memory() - before
        built[size] = scene, robot
    timed = {str(size): calls_of(*of) for size, of in built.items()}
    repeats = protocol.warm_up, protocol.steps, protocol.repeats
    found |= timing.in_turn(timed | {**others}, *repeats, clock)
    return found, {
        str(size): unequal(to_numpy(robot.get_dofs_position()))
        for size, (_, robot) in built.items()
    }


def explanations(build: Callable[..., Any]) -> dict[str, Calls]:
    """Return the further scenes of `DEEPER`.

    Args:
        build: makes a scene of a size, also with other substeps or with a `sphere`.
    """

    def calls(*given: Any) -> Calls:
        scene, body, *_ = build(*given)
        if "sphere" not in given:
            start(body)
        return calls_of(scene, body)

    parts = {
        f"{of}_{size}": calls(size, substeps, of.partition("_")[0])
        for of, substeps in PARTS.items()
        for size in ENDS
    }
    return parts | {
        name: timing.together([calls(size) for _ in range(4)])
        for name, size in FOUR.items()
    }
