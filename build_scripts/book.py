"""Build the course site: `make book`; options: `--help`."""

import sys

from robo_genesis.__main__ import main

sys.exit(main(["book", *sys.argv[1:]]))
