"""Install requirements.lock into `.venv`: `make .venv/.installed`.

Environment: TORCH_INDEX (an index with builds of Torch for the CPU; empty, pip's own
    index).
It needs the base Python alone, without packages.
Exit status: 0 installed, 1 failed, 130 interrupted.
"""

import os
import sys
from pathlib import Path

from robo_genesis.install import Installation, run

if __name__ == "__main__":
    lock = "requirements.lock"
    packages, index = (
        ("--no-deps", "--requirement", lock),
        os.environ.get("TORCH_INDEX", ""),
    )
    sys.exit(run(Installation(Path(".venv"), Path(lock), packages, index)))
