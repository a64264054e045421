"""Try another engine version: `make repin GENESIS=1.2.3`."""

import sys

from robo_genesis.__main__ import main

sys.exit(main(["repin", *sys.argv[1:]]))
