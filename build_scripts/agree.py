"""Require that two executions of pages agree: `make agree FIRST=folder SECOND=folder`.

Environment: FIRST and SECOND, folders that `make execute` filled on two machines.
Exit status: 0 they agree, 1 they differ or cannot be compared, 130 interrupted.
"""

import sys

from robo_genesis.pipeline.agreement import agree
from robo_genesis.pipeline.command import path, run

if __name__ == "__main__":
    sys.exit(run(lambda: agree(path("FIRST"), path("SECOND")), "accepted"))
