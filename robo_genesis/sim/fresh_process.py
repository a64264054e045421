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
        StartError: it took too long, ended with another status, or printed nothing.
    """
    command = [sys.executable, *arguments]
    how: dict[str, Any] = {"capture_output": True, "text": True, "timeout": TIMEOUT}
    try:
        done = subprocess.run(command, env=os.environ | changed, **how)
    except subprocess.TimeoutExpired as error:
        raise StartError(
            f"The process had not ended after {TIMEOUT} s and was killed."
        ) from error
    if done.returncode not in statuses or not done.stdout.strip():
        last = "\n".join((done.stdout + done.stderr).splitlines()[-10:])
        valid = " or ".join(map(str, statuses))
        raise StartError(
            f"The process ended with {ended(done.returncode)}, expected {valid} and some output. "
            f"Its last lines:\n{last}"
        )
    return done.stdout


def last_value(printed: str) -> Any:
    """Return the JSON value on the last line of what a process printed.

    Raises:
        StartError: the line is not JSON.
    """
    line = printed.rstrip().rpartition("\n")[2]
    try:
        return json.loads(line)
    except json.JSONDecodeError as error:
        raise StartError(
            f"The process should end with a line of JSON, found: {line!r}"
        ) from error
