"""Execute one page: `make execute PAGE=l04/lab`."""

import sys

from robo_genesis.__main__ import main

sys.exit(main(["execute", *sys.argv[1:]]))
