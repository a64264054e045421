"""requirements.lock: the exact version of every package that the course installs.

uv resolves pyproject.toml with the settings in its section `tool.uv`. Every version
stays that still fits, so a new pin changes only what it forces to change.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from robo_genesis.core.project import ROOT
from robo_genesis.pipeline.command import output_of

from .environment import LOCK, uv_environment


def write_lock(root: Path = ROOT, upgrade: Sequence[str] = ()) -> None:
    """Resolve and write the lock of a checkout.

    Args:
        root: the checkout.
        upgrade: packages whose newest version is taken.

    Raises:
        ProjectError: uv cannot resolve the project; the old lock is unchanged.
    """
    command = [sys.executable, "-m", "uv", "pip", "compile", "pyproject.toml"]
    command += ["--all-extras", "--no-annotate", "--custom-compile-command=make lock"]
    command += [f"--output-file={LOCK}", "--quiet"]
    command += [f"--upgrade-package={package}" for package in upgrade]
    refusal = "uv cannot resolve pyproject.toml"
    output_of(command, refusal, cwd=root, env=uv_environment(sys.executable))
