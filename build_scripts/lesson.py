"""Add a lesson that is made from the template: `make lesson NEW=l07`.

Exit status: 0 added, 1 refused or failed, 130 interrupted. A refused name changes
    nothing.
"""

import os
import sys

from robo_genesis.core.project import ROOT
from robo_genesis.maintain.new_lesson import add_lesson
from robo_genesis.pipeline.command import run

if __name__ == "__main__":
    sys.exit(run(lambda: add_lesson(ROOT, os.environ.get("NEW", "")), "added"))
