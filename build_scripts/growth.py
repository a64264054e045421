"""Measure how the course's cost grows with lessons and bundles: `make growth`.

It builds the book in a copy with up to seven copies of a lesson, each size with all pages executed
and with none; nothing else should run beside it. The figures go to `book/performance`, and are
committed with the book.
Exit status: 0 measured, 1 failed, 130 interrupted; unless it is 0, the old figures still stand.
"""

import sys
from functools import partial

from robo_genesis import growth, growth_measure, kept
from robo_genesis.build import Progress
from robo_genesis.command import as_published, run
from robo_genesis.pages import PageError
from robo_genesis.project import BOOK, CACHE, ROOT, ProjectError


def measured() -> list[str]:
    """Measure, keep the figures and return the last lines for the user."""
    say = partial(Progress(partial(print, flush=True)), "growth")
    found = growth_measure.measure(ROOT, CACHE, say)
    file = kept.keep(BOOK / growth.FILE, found)
    return [*growth.sentences(found), f"Growth: {file.relative_to(ROOT)}"]


def main() -> int:
    """Measure and return the exit status."""
    as_published()
    return run(measured, "recorded", (kept.KeptError, PageError, ProjectError))


if __name__ == "__main__":
    sys.exit(main())
