"""Which backend a run would find, as Torch sees it in a process of its own, before the run."""

import json
import subprocess
import sys

from robo_genesis.core.project import ProjectError

PROBE = """
import json, torch
count = torch.cuda.device_count() if torch.cuda.is_available() else 0
print(json.dumps([torch.version.hip, torch.version.cuda, count]))
"""
PROBE_SECONDS = 180.0


def foreseen_backend() -> str:
    """Return the backend that `auto` would find, as Torch sees it in a process of its own.

    It only spares a run that is bound to be refused: what counts is what the run itself finds.

    Raises:
        ProjectError: Torch does not answer.
    """
    try:
        done = subprocess.run(
            [sys.executable, "-c", PROBE],
            capture_output=True,
            text=True,
            check=True,
            timeout=PROBE_SECONDS,
        )
        hip, cuda, count = json.loads(done.stdout.splitlines()[-1])
    except (subprocess.SubprocessError, ValueError, IndexError) as error:
        last = str(getattr(error, "stderr", "") or error).strip().splitlines()[-1:]
        raise ProjectError(
            f"Torch of {sys.executable} does not say what it runs on: {' '.join(last)}\n"
            "Mend that environment, or name another with PYTHON=path."
        ) from error
    return backend_of(hip, cuda, count)


def backend_of(hip: str | None, cuda: str | None, count: int) -> str:
    """Return the backend of a Torch build and its number of devices.

    ROCm and CUDA both call their device `cuda`; the build's versions tell them apart.
    """
    if count and hip:
        return "amdgpu"
    return "cuda" if count and cuda else "cpu"
