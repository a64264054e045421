"""What a new process of Python prints: there, the engine starts for the first time."""

import json
import os
import subprocess
import sys
from collections.abc import Collection, Mapping
from typing import Any

from robo_genesis.core.text import ended

TIMEOUT = 600  # Seconds until a process counts as hanging


class StartError(RuntimeError):
    """A process did not print what it should; the message has its status and last lines."""


def run_python(
    arguments: list[str], changed: Mapping[str, str], statuses: Collection[int] = (0,)
) -> str:
    """Return what Python prints with these arguments.

    Args:
        arguments: of the interpreter.
        changed: environment variables beside those of this process.
        statuses: exit statuses of a process that did its work.

    Raises:
        StartError: it ended with another status, or printed nothing.
        TimeoutExpired: of `subprocess`; the process was killed.
    """
    command = [sys.executable, *arguments]
    done = subprocess.run(
        command,
        env=os.environ | changed,
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
    )
    if done.returncode not in statuses or not done.stdout.strip():
        last = "\n".join((done.stdout + done.stderr).splitlines()[-10:])
        valid = " or ".join(map(str, statuses))
        raise StartError(
            f"The process ended with {ended(done.returncode)}, expected {valid} and some output. "
            f"Its last lines:\n{last}"
        )
    return done.stdout


def last_value(printed: str) -> Any:
    """Return the JSON value on the last line of what a process printed."""
    return json.loads(printed.rstrip().rpartition("\n")[2])
