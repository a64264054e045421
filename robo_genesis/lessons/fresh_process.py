"""What a new process of Python prints: there, the engine starts for the first time."""

import os
import subprocess
import sys
from collections.abc import Mapping

TIMEOUT = 600
"""Seconds until a process counts as hanging."""


class StartError(RuntimeError):
    """A process did not print what it measures; the message has its last lines."""


def run_python(arguments: list[str], changed: Mapping[str, str]) -> str:
    """Return what Python prints with these arguments, whatever its exit status.

    Args:
        arguments: of the interpreter.
        changed: environment variables beside those of this process.

    Raises:
        StartError: it printed nothing.
    """
    done = subprocess.run(
        [sys.executable, *arguments], env=os.environ | changed, capture_output=True, text=True,
        timeout=TIMEOUT, check=False,
    )  # fmt: skip
    if not done.stdout.strip():
        last = "\n".join(done.stderr.splitlines()[-10:])
        raise StartError(f"The process printed nothing. It ended with:\n{last}")
    return done.stdout
