"""Change the engine pin: `make repin GENESIS=1.2.3`.

Tries the version in a fresh checkout with an environment of its own: all lessons, all
tests. Then it writes pin and lock; a report lists the changes. The tree must be clean;
nothing is committed.
Exit status: 0 changed, 1 refused or failed, 130 interrupted. Unless it is 0, the tree
    is unchanged.
"""

import os
import sys

from robo_genesis.maintain.repin import run_repin
from robo_genesis.pipeline.command import run

if __name__ == "__main__":
    sys.exit(run(lambda: run_repin(os.environ.get("GENESIS", "")), "changed"))
