"""Print the size of each executed page and compare it with the limits: a part of `make lint`.

Exit status: 0 all pages keep their limits; 1 otherwise.
"""

import sys

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.command import run
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.site.course.sizes import report


def main() -> int:
    """Print the lines and return the exit status."""
    lines, problems = report(find_pages(BOOK))
    print(*lines, sep="\n")
    print(*problems, sep="\n", end="\n" * bool(problems), file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(run(main, "compared"))
