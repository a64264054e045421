"""Write requirements.lock: `make lock`.

Usage: python build_scripts/lock.py [--keep] [NAME==VERSION ...]   (constraints)
Exit status: 0 written, 1 failed, 130 interrupted; unless it is 0, the old lock is
    unchanged.
"""

import argparse
import sys

from robo_genesis.maintain.lock import write_lock
from robo_genesis.pipeline.command import run

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--keep", action="store_true", help="keep installed versions that fit"
    )
    parser.add_argument("constraints", nargs="*", metavar="NAME==VERSION")
    args = parser.parse_args()
    sys.exit(run(lambda: [write_lock(args.constraints, args.keep)], "written"))
