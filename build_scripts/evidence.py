"""Record labs as evidence on this machine: `make evidence`."""

import sys

from robo_genesis.__main__ import main

sys.exit(main(["evidence", *sys.argv[1:]]))
