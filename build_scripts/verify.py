"""Verify evidence: `make verify`."""

import sys

from robo_genesis.__main__ import main

sys.exit(main(["verify", *sys.argv[1:]]))
