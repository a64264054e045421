"""Lines on the pages that run: each start and end, and now and then how far they are."""

import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robo_genesis.pipeline.pages.page_run import PageRun


class Lines:
    """Reports pages as lines."""

    def __init__(
        self,
        say: Callable[[str, str], None] = lambda what, event: None,
        every: float = 30.0,
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

    def show(self, runs: "Iterable[PageRun]") -> None:
        """Report the running pages, if it is time."""
        states = [f"{run.page.docname}: {state(run)}" for run in runs]
        if states and self.pause() == 0:
            self.say(f"{len(states)} running: {'; '.join(states)}", "")


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
