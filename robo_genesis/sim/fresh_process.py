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
    try:
        done = subprocess.run(
            [sys.executable, *arguments],
            env=os.environ | changed,
            capture_output=True,
            text=True,
            timeout=TIMEOUT,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        problem = f"had not ended after {TIMEOUT} s and was killed"
        raise StartError(_report(problem, error.stdout, error.stderr)) from error
    if done.returncode not in statuses or not done.stdout.strip():
        valid = " or ".join(map(str, statuses))
        problem = (
            f"ended with {ended(done.returncode)}, expected {valid} and some output"
        )
        raise StartError(_report(problem, done.stdout, done.stderr))
    return done.stdout


def _report(problem: str, *outputs: str | bytes | None) -> str:
    """Return what is wrong with a process, with its last lines; a killed one leaves bytes."""
    texts = (
        o.decode("utf8", "replace") if isinstance(o, bytes) else o or ""
        for o in outputs
    )
    last = "\n".join("".join(texts).splitlines()[-10:])
    return f"The process {problem}. Its last lines:\n{last}"


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
