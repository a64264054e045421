"""A long command with a log, which ends with the process that started it."""

import ctypes
import os
import signal
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

from robo_genesis.build.kernels import kill_with_descendants

OWN = (
    "GENESIS", "PYTHON", "PYTHONPATH", "BUNDLE", "RELEASE", "EXECUTED", "MAKEFLAGS", "MFLAGS",
    "MAKELEVEL",
)  # fmt: skip
"""Variables of the outer make that a make in another checkout must not get: a new pin makes
recorded bundles stale, which a release would refuse."""

HEARTBEAT = 60.0
"""Seconds between two calls of `waiting`."""


def run_logged(
    command: Sequence[str], folder: Path, log: Path, waiting: Callable[[], None] = lambda: None
) -> int:
    """Run a command with its output in a log, and return its exit status.

    Args:
        command: program and arguments.
        folder: where it runs.
        log: file of its output, written over.
        waiting: called once a minute while it runs.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("wb") as output:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env={name: value for name, value in os.environ.items() if name not in OWN},
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # a Ctrl-C of the terminal reaches this process alone
            preexec_fn=_end_with_parent,
        )
        try:
            while process.poll() is None:
                try:
                    process.wait(HEARTBEAT)
                except subprocess.TimeoutExpired:
                    waiting()
        finally:
            if process.poll() is None:
                kill_with_descendants([process.pid])
    return process.returncode


def _end_with_parent() -> None:
    """Ask Linux for a SIGTERM when the parent is gone, by SIGKILL too; make passes it on."""
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of <sys/prctl.h>
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGTERM)
