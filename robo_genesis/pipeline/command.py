"""What the commands share: progress, processes and exit statuses."""

import ctypes
import gc
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from robo_genesis.core.project import ProjectError
from robo_genesis.core.text import ended
from robo_genesis.evidence.refusals import BundleRefused

TIMEOUT = 1500  # Seconds for one cell; a page's front matter may set another

PR_SET_PDEATHSIG = (
    1  # The request of <linux/prctl.h> for a signal at the end of the parent
)
ANSI = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")  # A colour, or another code of a terminal

say = partial(print, flush=True)


class Progress:
    """Prints lines of elapsed time, stage, page and event."""

    def __init__(self, say: Callable[[str], None]):
        self.say, self.begin = say, time.monotonic()

    def __call__(self, stage: str, what: str, event: str = "") -> None:
        """Print one line."""
        elapsed = time.monotonic() - self.begin
        self.say(f"[{elapsed:7.1f} s] {stage:8} {what}  {event}".rstrip())


def collect_rarely() -> None:
    """Let Python collect cyclic garbage a thousand times less often than usual.

    Parsed pages are millions of objects that stay, and scanning them repeatedly takes a
    quarter of a render. Rare collection costs memory: some 100 MB for ten pages.
    """
    gc.set_threshold(1_000_000, 20, 100)


def run(task: Callable[[], Sequence[str] | int], done: str) -> int:
    """Run a task, print the last lines that it returns, and return the exit status.

    A cancelled CI job sends SIGTERM, which ends the task as Ctrl-C does, so that no
    kernel is left.

    Args:
        task: does the work and returns the last lines for the user, or the exit status.
        done: the verb for its result: `published`, `recorded`.

    Returns:
        0 done, 1 failed, 130 interrupted.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        result = task()
        if isinstance(result, int):
            return result
        print("\n".join(result))
        return 0
    except KeyboardInterrupt:
        print(f"\nInterrupted: nothing was {done}.", file=sys.stderr)
        return 130
    except (ProjectError, BundleRefused) as error:
        report = str(error)
    except OSError as error:
        report = f"A file cannot be used: {error}. Give it free space or write access."
    print(f"\n{report}\n\nFAILED: nothing was {done}.", file=sys.stderr)
    return 1


def end_with_parent(sent: signal.Signals = signal.SIGKILL) -> Callable[[], None]:
    """Return a `preexec_fn` of subprocess: Linux signals the child when its parent ends.

    This also holds for a parent that is killed by SIGKILL, as by the kernel when memory
    is short. The parent is the thread that starts the child.

    Args:
        sent: the signal for the child. SIGTERM is for children that pass it on, as
            `make` does.
    """
    parent, prctl = os.getpid(), ctypes.CDLL(None).prctl  # loaded before the fork

    def ask() -> None:
        prctl(PR_SET_PDEATHSIG, sent)
        if os.getppid() != parent:  # it ended before the request
            os.kill(os.getpid(), sent)

    return ask


def output_of(command: Sequence[str], refusal: str, **options: Any) -> str:
    """Run a command that ends with this process, and return what it prints.

    Args:
        command: the program and its arguments.
        refusal: how the message begins if the command fails.
        options: of `subprocess.run`.

    Raises:
        ProjectError: it failed; the message holds its output.
    """
    options |= {"capture_output": True, "text": True, "preexec_fn": end_with_parent()}
    done = subprocess.run(command, check=False, **options)
    if done.returncode:
        raise ProjectError(
            f"{refusal}, {ended(done.returncode)}:\n{done.stdout}{done.stderr}"
        )
    return done.stdout
