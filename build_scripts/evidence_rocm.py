"""Record labs in a container with ROCm: `make evidence-rocm`.

Environment: LESSON (one lab; unset, all labs without an accepted bundle), and the switches of
engine and drivers, which are passed to the container.
It builds the image of `.rocm/Dockerfile` and runs `make evidence BACKEND=amdgpu` in it, on this
checkout.
Exit status: 0 recorded, 1 nothing was started, otherwise that of the command that failed.
"""

import os
import shutil
import sys
from pathlib import Path

from robo_genesis.pipeline.recording.rocm_container import ContainerError, Host, record

if __name__ == "__main__":
    try:
        sys.exit(record(Host(Path(__file__).resolve().parents[1], shutil.which, os.environ)))
    except ContainerError as error:
        sys.exit(f"{error}\n\nFAILED: nothing was recorded.")
