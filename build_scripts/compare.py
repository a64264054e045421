"""Compare two bundles: `make compare OLD=path NEW=path`."""

import sys

from robo_genesis.__main__ import main

sys.exit(main(["compare", *sys.argv[1:]]))
