"""Lines on the pages that run: each start and end, and now and then how far they are."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robo_genesis.pipeline.pages.page_run import PageRun

# Prints the name of a page and an event, or the running pages and "".
Say = Callable[[str, str], None]
EVERY = 30.0  # Seconds without an event after which the running pages are reported


def start(run: "PageRun") -> str:
    """Return what the line at the start of a run says."""
    expected = f", about {run.last.seconds:.0f} s" if run.last else ""
    return f"started: {len(run.page.code.sources)} cells{expected}; its log: {run.log}"


def state(run: "PageRun") -> str:
    """Return cell and elapsed time of a run."""
    cells = len(run.page.code.sources)
    cell = f"cell {run.cell} of {cells}" if run.cell else "kernel starts"
    cell += " waits" if run.waits else ""
    elapsed = time.monotonic() - run.begin
    return f"{cell}, {elapsed:.0f} s"
