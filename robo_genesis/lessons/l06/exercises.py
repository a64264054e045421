"""Checks of the functions that a student writes in L06's lab; see `core/exercises.py`."""

from functools import partial
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.exercises import (
    Written,
    as_test,
    refused,
    same_array,
)
from robo_genesis.sim.arm.reaching import ANSWERS

from . import spec

MEASURES = False


@as_test
def acceptance(accept: Written) -> Findings:
    """Check `accept(q, error, position_tolerance, rotation_tolerance)` on rows (k, d) and (k, 6).

    It returns one truth value for each row, (k,).
    """
    rows = [*ANSWERS.items()]
    for label, some in (("all", rows), ("backwards", rows[::-1]), ("one", rows[3:4])):
        q, error = np.full((len(some), 9), 0.1), np.zeros((len(some), 6))
        for k, (_, ((joint, value), residual, _)) in enumerate(some):
            q[k, joint], error[k] = value, residual
        found = np.asarray(accept(q, error, *spec.IK.tolerances))
        yield equal(f"{label}.shape", str(found.shape), str((len(some),)))
        yield equal(f"{label}.type", found.dtype.name, "bool")
        for (name, (*_, right)), value in zip(some, found, strict=True):
            yield equal(f"{label}.{name}", value, right)
    loose = accept(np.zeros((2, 9)), np.full((2, 6), 0.1), 0.2, 0.2)
    yield equal("looser_tolerances", np.asarray(loose).tolist(), [True, True])


class Robot:
    """Keeps the commands of some environments, and broadcasts as the engine does."""

    def __init__(self, n_envs: int = 4) -> None:
        self.scene = SimpleNamespace(n_envs=n_envs)
        self.target = 0.5 - np.arange(3.0 * n_envs).reshape(n_envs, 3)
        self.calls = 0

    def control_dofs_position(
        self, position: Any, dofs_idx_local: Any = None, envs_idx: Any = None
    ) -> None:
        """Keep positions of some DOFs in some environments."""
        dofs = range(3) if dofs_idx_local is None else dofs_idx_local
        envs = range(len(self.target)) if envs_idx is None else np.atleast_1d(envs_idx)
        rows = [int(k) for k in envs]  # a mask is 0 and 1
        self.target[np.ix_(rows, list(dofs))] = position
        self.calls += 1


# Environments of the scene, DOFs and environments of commands that must be sent.
VALID = {
    "two_rows": (4, [0, 1, 2], [1, 3]),
    "other_order": (4, [0, 1, 2], [3, 1]),
    "some_dofs": (4, [2, 0], [0, 2]),
    "all_rows": (4, [0, 1, 2], [0, 1, 2, 3]),
    "more_environments": (6, [0, 1, 2], [5, 0]),
}

# The engine would send many of these commands. Shapes that do not have one row for each
# of two environments, with three DOFs; (2,) with two.
SHAPES = ((1, 3), (3,), (6,), (3, 2), (2,), (2, 3, 1), (3, 3))

# Environments that do not fit two rows and a scene of three environments.
MASK = np.array([False, True])
NUMBERS: tuple[Any, ...] = ([], [1], [1, 1], [1, 3], [-1, 1], [1.5, 0], MASK)

# Shape and environments of commands that must be refused.
WRONG = [
    ((3,), [1]),
    *product(SHAPES, [[0, 2]]),
    *product([(2, 3)], NUMBERS),
]


@as_test
def subset(command: Written) -> Findings:
    """Check `command(robot, dofs, q, envs)`: one call, row k for environment `envs[k]`."""
    for name, (count, dofs, envs) in VALID.items():
        robot = Robot(count)
        expected = robot.target.copy()
        q = 0.3 + np.arange(12.0).reshape(4, 3)[: len(envs), : len(dofs)]
        expected[np.ix_(envs, dofs)] = q
        command(robot, dofs, q, np.array(envs))
        yield equal(f"{name}.wrong_entries", (robot.target != expected).sum(), 0)
        yield equal(f"{name}.commands_sent", robot.calls, 1)
    robot = Robot(3)
    for shape, envs in WRONG:
        dofs = [0, 2] if shape == (2,) else [0, 1, 2]
        error = refused(partial(command, robot, dofs, np.ones(shape), envs))
        label = f"shape_{shape}_for_{envs}"
        yield equal(f"{label}.raises_value_error", isinstance(error, ValueError), True)
        yield equal(f"{label}.commands_sent", robot.calls, 0)
    command(robot, [0, 1, 2], np.zeros((0, 3)), [])
    yield equal("no_environments.commands_sent", robot.calls, 0)


# Time of one undisturbed step of a simulated machine, of one wait, and of rounding [s].
STEP, WAIT, TINY = 0.01, 2e-3, 1e-9


class Machine:
    """A machine that queues steps and does them when `finish` waits for them, as a GPU does.

    `durations` of its steps are in `STEP`. A wait costs `WAIT` more.
    """

    def __init__(self, *durations: float) -> None:
        self.durations, self.now, self.started, self.done = durations, 100.0, 0, 0

    def step(self) -> None:
        """Queue a step."""
        self.started += 1

    def finish(self) -> None:
        """Do all queued steps."""
        self.now += WAIT + STEP * sum(self.durations[self.done : self.started])
        self.done = self.started

    def clock(self) -> float:
        """Return the time [s]."""
        return self.now


# Durations of the steps of the warm-up, steps of a repeat, and their duration in each
# repeat.
TRIALS: dict[str, Any] = {
    "steady": ([1, 1, 1], 10, [1] * 5),
    "slow_first_steps": ([800, 50, 1, 1], 10, [1] * 3),
    "one_disturbed_repeat": ([1, 1], 10, [1, 1, 30, 1, 1]),
    "no_warm_up": ([], 4, [1] * 3),
    "five_different_repeats": ([1, 1], 2, [9, 0.1, 1, 30, 0.2]),
    "an_even_number_of_repeats": ([1, 1], 3, [1.5, 8, 0.5, 0.1]),
}


@as_test
def throughput(measure: Written) -> Findings:
    """Check `measure(step, finish, clock, warm_up, steps, repeats)`: the median of a step [s].

    It runs on simulated machines, so the time of the real machine decides nothing.
    """
    for name, (first, steps, repeats) in TRIALS.items():
        machine = Machine(*first, *np.repeat(repeats, steps))
        calls = machine.step, machine.finish, machine.clock
        found = measure(*calls, len(first), steps, len(repeats))
        expected = STEP * np.median(repeats) + WAIT / steps
        yield from same_array(f"{name}.step_s", found, expected, TINY)
        yield equal(f"{name}.number_of_steps", machine.started, len(machine.durations))
