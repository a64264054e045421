"""Measure what the pages' sets of compiled kernels cost, cold and warm: `make costs`.

Each page that marks such sets runs twice, from an empty cache and again; nothing else should run
beside it. The figures go to `book/performance`, and are committed with the book.
Exit status: 0 measured, 1 failed, 130 interrupted; unless it is 0, the old figures still stand.
"""

import sys

from robo_genesis.build import BuildError, only_build
from robo_genesis.command import as_published, run
from robo_genesis.kernel_costs import CostsError, Measuring, measure
from robo_genesis.pages import PageError, find_pages
from robo_genesis.project import BOOK, CACHE, ProjectError


def measured() -> list[str]:
    """Measure all pages and return the last lines for the user."""
    with only_build(CACHE):
        files = measure(find_pages(BOOK), Measuring(say=lambda line: print(line, flush=True)))
    return [f"Costs: {path.relative_to(BOOK.parent)}" for path in files]


def main() -> int:
    """Measure and return the exit status."""
    as_published()
    return run(measured, "recorded", (CostsError, BuildError, PageError, ProjectError))


if __name__ == "__main__":
    sys.exit(main())
