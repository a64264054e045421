"""Print the built site: `make pdf`. With `--check`, only say whether Chromium is there to do it.

Writes one PDF for each lesson and one of the whole course to `book/_build/pdf/`, where the next
build of the site removes them. Exit status: 0 printed, 1 failed, 130 interrupted.
"""

import sys
from pathlib import Path

from robo_genesis.build import BuildError, only_build
from robo_genesis.command import run
from robo_genesis.pages import PageError
from robo_genesis.pdf import PdfError, chromium, print_site
from robo_genesis.project import BOOK, CACHE


def printed() -> list[str]:
    """Print, and return a line for each PDF; no build may swap the site meanwhile."""
    with only_build(CACHE):
        return [line(path) for path in print_site(BOOK, lambda text: print(text, flush=True))]


def found() -> list[str]:
    """Return a line that names Chromium, before the site is built for it."""
    return [f"Chromium: {chromium()}"]


def line(path: Path) -> str:
    """Return where a PDF is, and its size."""
    return f"{path}  {path.stat().st_size / 1e6:.1f} MB"


if __name__ == "__main__":
    task = found if sys.argv[1:] == ["--check"] else printed
    sys.exit(run(task, "printed", (PdfError, BuildError, PageError)))
