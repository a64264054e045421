"""How far the running pages are: lines, or bars on a terminal."""

import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from robo_genesis.pipeline.command import Progress, say
from robo_genesis.pipeline.pages.folder import Record

if TYPE_CHECKING:
    from rich.console import Console

HEARTBEAT = 30.0
REFRESH = 0.5


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


class Bars(Lines):
    """Reports pages as bars below the lines of starts and ends.

    No thread draws them: it would receive a Ctrl-C that `kernels.interrupts_blocked` holds back
    from this one.
    """

    def __init__(self, line: Callable[[str, str], str], console: "Console") -> None:
        """Draw on a terminal.

        Args:
            line: returns a line for the name of a page and an event.
            console: the terminal.
        """
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Drawn

        # The terminal breaks lines, so that a copied path has no line end in it.
        above = partial(console.print, soft_wrap=True, markup=False, highlight=False)
        super().__init__(lambda what, event: above(line(what, event)))
        columns = (
            TextColumn("{task.description}", markup=False),
            BarColumn(10),
            TextColumn("{task.fields[state]}", markup=False),
        )
        self.drawn = Drawn(
            *columns,
            console=console,
            auto_refresh=False,
            transient=True,
            redirect_stdout=False,
            redirect_stderr=False,
        )

    def pause(self) -> float:
        """Return the seconds after which the bars are drawn again."""
        return REFRESH

    def show(self, pages: Sequence[Underway]) -> None:
        """Draw one bar for each running page."""
        now = time.monotonic()
        for task in self.drawn.task_ids:
            self.drawn.remove_task(task)
        for page in pages:
            done, state = max(0, page.cell - 1), page.state(now)
            self.drawn.add_task(page.name, total=page.cells, completed=done, state=state)
        self.drawn.refresh()


@contextmanager
def reporting(progress: Progress) -> Iterator[Lines]:
    """Report the execution of pages as bars on a terminal, and as lines elsewhere and in CI.

    Args:
        progress: prints the lines of the command; bars appear only if it prints to stdout.
    """
    if progress.say is say and sys.stdout.isatty() and not os.environ.get("CI"):
        from rich.console import Console

        console = Console()
        if console.is_interactive:  # not where TERM is dumb
            bars = Bars(partial(progress.line, "execute"), console)
            with bars.drawn:
                yield bars
            return
    yield Lines(partial(progress, "execute"))
