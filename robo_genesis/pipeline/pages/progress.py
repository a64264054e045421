"""How far the running pages are, in lines."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from robo_genesis.pipeline.pages.folder import Record

HEARTBEAT = 30.0


@dataclass(slots=True)
class Underway:
    """One page that runs.

    `cells` is the number of its code cells and `cell` the one that runs, counted from 1; 0 while
    the kernel starts. `last` is the record of its last stored run, `log` the file that gets what
    the engine writes, None if it is not kept. Times are seconds of the monotonic clock.
    """

    name: str
    cells: int
    last: Record | None = None
    log: Path | None = None
    begin: float = field(default_factory=time.monotonic)
    cell: int = 0
    cell_begin: float = 0.0

    def reach(self, cell: int) -> None:
        """Note that a cell starts."""
        self.cell, self.cell_begin = cell, time.monotonic()

    def left(self, now: float) -> float | None:
        """Return the estimated seconds to the end of the last cell, None without an earlier run.

        Cells that wait are expected to take as long as last time. If the page has another number
        of cells now, the estimate is for the whole page.
        """
        if self.last is None:
            return None
        seconds = self.last.cell_seconds
        if self.cell == 0 or len(seconds) != self.cells:
            return max(0.0, self.last.seconds - (now - self.begin))
        this_cell = max(0.0, seconds[self.cell - 1] - (now - self.cell_begin))
        return this_cell + sum(seconds[self.cell :])

    def started(self) -> str:
        """Return what the line at its start says."""
        expected = f", about {self.last.seconds:.0f} s" if self.last else ""
        followed = f"; its log: {self.log}" if self.log else ""
        return f"started: {self.cells} cells{expected}{followed}"

    def state(self, now: float) -> str:
        """Return cell, elapsed time and estimated remaining time."""
        cell = f"cell {self.cell} of {self.cells}" if self.cell else "kernel starts"
        left = self.left(now)
        estimate = "" if left is None else f", ~{left:.0f} s left"
        return f"{cell}, {now - self.begin:.0f} s{estimate}"


class Lines:
    """Reports pages as lines: each start and end, and now and then how far the pages are."""

    def __init__(
        self, say: Callable[[str, str], None] = lambda what, event: None, every: float = HEARTBEAT
    ) -> None:
        """Report to `say`, which takes a page's name and an event, or the running pages and "".

        Args:
            say: prints one line.
            every: seconds without a line after which the running pages are reported.
        """
        self._say, self.every, self.last = say, every, time.monotonic()

    def say(self, what: str, event: str) -> None:
        """Print one line."""
        self._say(what, event)
        self.last = time.monotonic()

    def pause(self) -> float:
        """Return the seconds after which `show` is due."""
        return max(0.0, self.last + self.every - time.monotonic())

    def show(self, pages: Sequence[Underway]) -> None:
        """Report the running pages, if it is time."""
        if pages and self.pause() == 0:
            now = time.monotonic()
            states = "; ".join(f"{page.name}: {page.state(now)}" for page in pages)
            self.say(f"{len(pages)} running: {states}", "")
