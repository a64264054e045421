"""The backend that a run would find, as Torch reports it in a process of its own before the run."""

import json
import subprocess
import sys

from robo_genesis.build.command import end_with_parent
from robo_genesis.core.project import ProjectError

PROBE = """
import json, torch
count = torch.cuda.device_count() if torch.cuda.is_available() else 0
print(json.dumps([torch.version.hip, torch.version.cuda, count]))
"""
PROBE_SECONDS = 180.0


def expected_backend() -> str:
    """Return the backend that `auto` would find.

    It only avoids a run that would be refused: the run itself decides.

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
            preexec_fn=end_with_parent(),
        )
        hip, cuda, count = json.loads(done.stdout.splitlines()[-1])
    except (subprocess.SubprocessError, ValueError, IndexError) as error:
        last = str(getattr(error, "stderr", "") or error).strip().splitlines()[-1:]
        raise ProjectError(
            f"Torch of {sys.executable} does not report its devices: {' '.join(last)}\n"
            "Repair that environment, or name another with PYTHON=path."
        ) from error
    # ROCm and CUDA both call their device `cuda`; the build's versions distinguish them.
    if count and hip:
        return "amdgpu"
    return "cuda" if count and cuda else "cpu"
