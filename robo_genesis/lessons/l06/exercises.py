"""Checks of the functions that a student writes in L06's lab; see `core/exercises.py`."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding, equal, within
from robo_genesis.core.exercises import as_test, refused
from robo_genesis.lessons.l06 import spec
from robo_genesis.sim.arm.reaching import ANSWERS

MEASURES = False


@as_test
def acceptance(accept: Callable[..., Any]) -> Iterator[Finding]:
    """Check `accept(q, error, position_tolerance, rotation_tolerance)` on rows (k, d) and (k, 6).

    It returns one truth value for each row, (k,).
    """
    names = list(ANSWERS)
    for label, rows in (("all", names), ("backwards", names[::-1]), ("one", names[3:4])):
        changed = [ANSWERS[name][0] for name in rows]
        q = np.array([np.where(np.arange(9) == joint, value, 0.1) for joint, value in changed])
        error = np.array([ANSWERS[name][1] for name in rows], dtype=float)
        found = np.asarray(accept(q, error, *spec.IK.tolerances))
        yield equal(f"{label}.shape", list(found.shape), [len(rows)])
        if found.shape == (len(rows),):
            for name, value in zip(rows, found, strict=True):
                yield equal(f"{label}.{name}", bool(value), ANSWERS[name][2])
    loose = accept(np.zeros((2, 9)), np.full((2, 6), 0.1), 0.2, 0.2)
    yield equal("looser_tolerances", np.asarray(loose, dtype=bool).tolist(), [True, True])


class Robot:
    """Keeps the commands of four environments, and broadcasts as the engine does."""

    def __init__(self) -> None:
        self.scene = SimpleNamespace(n_envs=4)
        self.target = np.zeros((4, 3))
        self.calls = 0

    def control_dofs_position(
        self, position: Any, dofs_idx_local: Any = None, envs_idx: Any = None
    ) -> None:
        """Keep positions of some DOFs in some environments."""
        dofs = range(3) if dofs_idx_local is None else dofs_idx_local
        envs = range(4) if envs_idx is None else np.atleast_1d(envs_idx)
        self.target[np.ix_(list(envs), list(dofs))] = position
        self.calls += 1


VALID: dict[str, tuple[Sequence[int], Sequence[int]]] = {
    "two_rows": ([0, 1, 2], [1, 3]),
    "other_order": ([0, 1, 2], [3, 1]),
    "some_dofs": ([2, 0], [0, 2]),
    "all_rows": ([0, 1, 2], [0, 1, 2, 3]),
}
"""DOFs and environments of commands that must be sent."""

# The engine would send many of these commands.
REFUSED: dict[str, tuple[int, tuple[int, ...], Sequence[int]]] = {
    "one_row_for_two": (3, (1, 3), [1, 3]),
    "no_rows_for_two": (3, (3,), [1, 3]),
    "one_number_for_each": (2, (2,), [1, 3]),
    "one_column": (3, (2, 1), [1, 3]),
    "rows_of_all_for_two": (3, (4, 3), [1, 3]),
    "two_rows_for_one": (3, (2, 3), [1]),
    "named_twice": (3, (2, 3), [1, 1]),
    "does_not_exist": (3, (2, 3), [1, 4]),
    "negative": (3, (2, 3), [-1, 1]),
}
"""Numbers of DOFs, shapes and environments that must raise a ValueError."""


@as_test
def subset(command: Callable[..., Any]) -> Iterator[Finding]:
    """Check `command(robot, dofs, q, envs)`: row k of `q` for environment `envs[k]`."""
    for name, (dofs, envs) in VALID.items():
        robot, expected = Robot(), np.zeros((4, 3))
        q = np.arange(1.0, 1 + len(envs) * len(dofs)).reshape(len(envs), len(dofs))
        expected[np.ix_(envs, dofs)] = q
        command(robot, dofs, q, np.array(envs))
        yield equal(f"{name}.wrong_entries", int((robot.target != expected).sum()), 0)
    for name, (count, shape, envs) in REFUSED.items():
        robot = Robot()
        error = refused(partial(command, robot, list(range(count)), np.ones(shape), envs))
        yield equal(f"{name}.raises_value_error", isinstance(error, ValueError), True)
        yield equal(f"{name}.commands_sent", robot.calls, 0)
    robot = Robot()
    command(robot, [0, 1, 2], np.zeros((0, 3)), [])
    yield equal("no_environments.commands_sent", robot.calls, 0)


STEP, TINY = 0.01, 1e-9
"""Time of one undisturbed step of a pretended machine, and what rounding explains [s]."""


class Machine:
    """A machine that queues steps and does them when somebody waits for them, as a GPU does.

    `slow` gives steps another duration [s] by their number.
    """

    def __init__(self, slow: dict[int, float]) -> None:
        self.slow, self.now, self.started, self.done = slow, 100.0, 0, 0

    def step(self) -> None:
        """Queue a step."""
        self.started += 1

    def finish(self) -> None:
        """Do all queued steps."""
        self.now += sum(self.slow.get(n, STEP) for n in range(self.done, self.started))
        self.done = self.started

    def clock(self) -> float:
        """Return the time [s]."""
        return self.now


TRIALS: dict[str, tuple[tuple[int, int, int], dict[int, float]]] = {
    "steady": ((3, 10, 5), {}),
    "slow_first_steps": ((4, 10, 3), {0: 8.0, 1: 0.5}),
    "one_repeat": ((6, 5, 1), {0: 8.0}),
    "one_disturbed_repeat": ((2, 10, 5), {25: 3.0}),
    "no_warm_up": ((0, 4, 3), {}),
    "fast_first_and_slow_last_repeat": ((2, 2, 5), {2: STEP / 9, 3: STEP / 9, 11: 3.0}),
}
"""Warm-up, steps and repeats of a call of the student's function, and its machine's slow steps."""


@as_test
def throughput(measure: Callable[..., Any]) -> Iterator[Finding]:
    """Check `measure(step, finish, clock, warm_up, steps, repeats)`: the median of a step [s].

    It runs on pretended machines, so the time of the real machine decides nothing.
    """
    for name, ((warm_up, steps, repeats), slow) in TRIALS.items():
        machine = Machine(slow)
        calls = machine.step, machine.finish, machine.clock
        found = float(measure(*calls, warm_up, steps, repeats))
        yield within(f"{name}.step_s", found, STEP, TINY)
        yield equal(f"{name}.number_of_steps", machine.started, warm_up + steps * repeats)
