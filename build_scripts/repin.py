"""Change the engine pin: `make repin GENESIS=1.2.3`.

Tries the version in a git worktree with an environment of its own: all lessons, all tests. Then it
writes pin and lock; a report says what changed. The tree must be clean; nothing is committed.
Exit status: 0 changed, 1 refused or failed, 130 interrupted. Unless it is 0, the tree is as it was.
"""

import os
import sys

from robo_genesis.build.command import run
from robo_genesis.core.project import CACHE, ROOT, ProjectError
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.maintain.pin import RepinError, installable_versions
from robo_genesis.maintain.repin import Repin, run_repin


def main() -> int:
    """Change the pin and return the exit status."""
    asked = Repin(
        genesis=os.environ.get("GENESIS", ""),
        root=ROOT,
        cache=CACHE,
        versions=installable_versions,
        say=lambda line: print(line, flush=True),
    )
    return run(lambda: run_repin(asked), "changed", (RepinError, ProjectError, BundleRefused))


if __name__ == "__main__":
    sys.exit(main())
