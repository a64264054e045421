"""Record labs in a container with ROCm: `make evidence-rocm`.

Environment: LESSON (one lab; unset, all labs without an accepted bundle), and the
    switches of
engine and drivers, which are passed to the container. It builds the image of
`.rocm/Dockerfile` and runs `make evidence BACKEND=amdgpu` in it, on this checkout.
Exit status: 0 recorded, 1 nothing was started, 130 interrupted, otherwise that of the
    command that
failed.
"""

import os
import shutil
import sys

from robo_genesis.core.project import ROOT
from robo_genesis.pipeline.command import run
from robo_genesis.pipeline.recording.rocm_container import Host, record

if __name__ == "__main__":
    sys.exit(run(lambda: record(Host(ROOT, shutil.which, os.environ)), "recorded"))
