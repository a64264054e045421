"""Check of the throughput measurement that a student writes in L06's lab.

It runs on pretended machines whose clock is known, so the time of the real machine decides nothing.
"""

from collections.abc import Callable, Iterator
from typing import Any

from robo_genesis.core.checks import Check, Finding, equal, within
from robo_genesis.core.exercises import outcome

MEASURES = False

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


def throughput(measure: Callable[..., Any]) -> list[Check]:
    """Check `measure(step, finish, clock, warm_up, steps, repeats)`: the median of a step [s]."""

    def findings(_: None) -> Iterator[Finding]:
        for name, ((warm_up, steps, repeats), slow) in TRIALS.items():
            machine = Machine(slow)
            calls = machine.step, machine.finish, machine.clock
            found = float(measure(*calls, warm_up, steps, repeats))
            yield within(f"{name}.step_s", found, STEP, TINY)
            yield equal(f"{name}.number_of_steps", machine.started, warm_up + steps * repeats)

    return outcome("throughput", findings)
