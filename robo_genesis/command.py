"""How a long command ends: its last lines, or why it failed, and the exit status."""

import signal
import sys
from collections.abc import Callable, Sequence

from robo_genesis.apply import UnfinishedError


def run(task: Callable[[], Sequence[str]], done: str, failures: tuple[type[Exception], ...]) -> int:
    """Run a task, print its last lines and return the exit status.

    A cancelled CI job sends SIGTERM: it takes the same way out as Ctrl-C, so that no kernel stays
    behind.

    Args:
        task: does the work and returns the last lines for the user.
        done: what it does to its result: `published`, `recorded`.
        failures: exceptions whose message is a whole report.

    Returns:
        0 done, 1 failed, 130 interrupted.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        print("\n".join(task()))
    except UnfinishedError as error:
        return _failed(str(error), "the change is not complete")
    except failures as error:
        return _failed(str(error), f"nothing was {done}")
    except OSError as error:
        report = f"A file cannot be used: {error}. Give it free space or write access."
        return _failed(report, f"nothing was {done}")
    except KeyboardInterrupt:
        print(f"\nInterrupted: nothing was {done}.", file=sys.stderr)
        return 130
    return 0


def _failed(report: str, outcome: str) -> int:
    print(f"\n{report}\n\nFAILED: {outcome}.", file=sys.stderr)
    return 1
