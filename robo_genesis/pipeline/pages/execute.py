"""Execute the pages' code cells in clean kernels, in parallel, and keep them in the store."""

import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

from robo_genesis.core import project
from robo_genesis.core.text import printable

from .book import Page
from .page_folder import PageRefused
from .page_run import PageRun
from .results import Failure, PageResult
from .store import last_record, stored_result

# Prints what an event is about, a page or several, and the event.
Say = Callable[[str, str], None]
EVERY = 30.0  # Seconds without an event after which the running pages are reported
UNKNOWN = 60.0  # Seconds that a page takes of which nothing is known


def execute_pages(
    pages: Sequence[Page],
    places: Mapping[str, Path],
    *,
    seconds: Mapping[str, float],
    jobs: int,
    timeout: int,
    environment: Mapping[str, str],
    logs: Path,
    say: Say,
    accept: Callable[[PageResult], object],
) -> list[PageResult]:
    """Execute the pages that the store does not have yet; try all of them.

    The longest start first, if possible beside pages of other lessons. From its first
    cell tagged `alone`, a page runs when no other does: it starts after the others, and
    waits there until all have ended or wait. If no kernel is compiled yet, one page
    starts before the others, which would compile the same kernels: the engine saves
    them when a process ends. It is the page with cells tagged `compiles-first`, until
    their end, or else the first lab.

    Args:
        pages: the pages of the book.
        places: where the store has each page, or will have it; see `store.places`. A
            page that fails leaves its place as it is.
        seconds: what pages take, by name, if the store does not know it.
        jobs: how many pages run at once.
        timeout: seconds for one cell; a page's front matter may set another.
        environment: variables for the kernels.
        logs: the folder that keeps, for each page, a file with all that its last run
            wrote.
        say: prints each event, and now and then how far the running pages are.
        accept: called once for each page that did not fail, after the next page
            started.

    Returns:
        One result for each page, in the order of `pages`.
    """
    results = _stored(pages, places, say)
    logs.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="robo-") as scratch:
        waiting = []
        for page in pages:
            if page.docname in results:
                continue
            place = places[page.docname]
            log, last = logs / f"{place.parent.name}.log", last_record(place.parent)
            expected = last.seconds if last else seconds.get(page.docname, UNKNOWN)
            waiting.append(
                PageRun(page, place, Path(scratch), log, timeout, environment, expected)
            )
        first = _first(waiting, environment)
        schedule = Schedule(in_order(waiting, first), first, jobs, say)
        if waiting:
            say(f"{len(waiting)} pages to execute", schedule.left)
        finished = [*results.values()]
        try:
            while schedule.waiting or schedule.running or finished:
                schedule.start_pages()
                for result in finished:
                    if not result.failure:
                        accept(result)
                finished = schedule.ended_pages() if schedule.running else []
                results |= {result.page.docname: result for result in finished}
        finally:
            schedule.stop()
    return [results[page.docname] for page in pages]


@dataclass(slots=True)
class Schedule:
    """The pages that wait and those that run, each in a thread of its own.

    `waiting` has them, the preferred ones first; `first` is the one that starts
    before the others, if there is one. `jobs` run at once. `say` prints each event.
    """

    waiting: list[PageRun]
    first: PageRun | None
    jobs: int
    say: Say
    running: dict[PageRun, Thread] = field(default_factory=dict)
    # The number of pages that ended, what they should have taken and what they took.
    ended: int = 0
    expected: float = 0.0
    elapsed: float = 0.0
    # A run that ended with its result, or with None where it waits for its turn.
    events: SimpleQueue[tuple[PageRun, PageResult | None]] = field(
        default_factory=SimpleQueue
    )

    def start_pages(self) -> None:
        """Start pages while there is room, unless one is alone."""
        while (
            self.waiting
            and self.first in (None, self.waiting[0])
            and sum(not run.waits for run in self.running) < self.jobs
            and not any(run.alone and not run.waits for run in self.running)
        ):
            run = self.next_page()
            self.waiting.remove(run)
            cells = f"started: {len(run.page.code.sources)} cells, about {run.expected:.0f} s"
            self.say(run.page.docname, f"{cells}; its log: {run.log}")
            self.running[run] = Thread(target=self._work, args=(run,), daemon=True)
            self.running[run].start()

    def next_page(self) -> PageRun:
        """Return the first page that waits, if possible of a lesson of which none runs.

        Pages of one lesson compile the same kernels, which the engine saves when a process
        ends. A page with `alone` overtakes none.
        """
        busy = {run.page.lesson for run in self.running if not run.waits} - {None}
        others = (
            run
            for run in self.waiting
            if run.page.lesson not in busy and not run.page.alone
        )
        return next(others, self.waiting[0])

    def ended_pages(self) -> list[PageResult]:
        """Wait for the next event or report; return the result of a page that has ended."""
        if all(run.waits for run in self.running):
            run = next(iter(self.running))
            run.waits = False
            run.turn.set()
        try:
            run, result = self.events.get(timeout=EVERY)
        except Empty:
            states = [f"{n.page.docname}: {n.state}" for n in self.running]
            self.say(f"{len(states)} running: {'; '.join(states)}", self.left)
            return []
        if run is self.first and (result or run.cell > run.page.compiles_first > 0):
            self.first = None
        if result is None:
            return []
        del self.running[run]
        self.ended += 1
        self.expected += run.expected
        self.elapsed += result.seconds
        more = f"; {self.left}"
        if result.failure:
            more = f": {printable(' '.join(str(result.failure).split()))}"
        self.say(run.page.docname, f"{result.status} in {result.seconds:.0f} s{more}")
        return [result]

    @property
    def left(self) -> str:
        """How many pages ended, and how long the others take.

        The pace is that of the ended pages, but half of all pages count as expected:
        the first ones compile for the others, so they measure little.
        """
        runs = [*self.waiting, *self.running]
        expected = sum(run.expected for run in runs)
        usual = max((expected + self.expected) / 2, 1.0)
        pace = (self.elapsed + usual) / (self.expected + usual)
        expected -= sum(min(run.elapsed, run.expected) for run in self.running)
        minutes = expected * pace / max(min(self.jobs, len(runs)), 1) / 60
        done = f"{self.ended} of {self.ended + len(runs)} pages"
        return f"{done}, about {ceil(minutes)} min left" if runs else done

    def stop(self) -> None:
        """Kill all kernels, also one that a thread is just about to start."""
        for run, thread in self.running.items():
            while thread.is_alive():
                run.turn.set()
                if run.kernel:
                    run.kernel.kill()
                thread.join(timeout=0.2)

    def _work(self, run: PageRun) -> None:
        try:
            result = run.execute(lambda: self.events.put((run, None)))
        except Exception as error:  # of a full disk, or a defect of this module
            failure = Failure(type(error).__name__, str(error))
            result = PageResult(run.page, "failed", run.place, failure=failure)
        self.events.put((run, result))


def in_order(runs: Iterable[PageRun], first: PageRun | None = None) -> list[PageRun]:
    """Return runs in the order in which they start.

    After the `first`, the longest come first, those with `alone` last.
    """

    def sooner(run: PageRun) -> tuple[bool, bool, float]:
        return run is not first, bool(run.page.alone), -run.expected

    return sorted(runs, key=sooner)


def _first(
    waiting: Sequence[PageRun], environment: Mapping[str, str]
) -> PageRun | None:
    """Return the page that starts before the others, if no kernel is compiled yet."""
    if not project.nothing_compiled(environment):
        return None
    tagged = [run for run in waiting if run.page.compiles_first]
    labs = [run for run in waiting if run.page.page == "lab" and not run.page.alone]
    return next(iter(tagged + labs), None)


def _stored(
    pages: Sequence[Page], places: Mapping[str, Path], say: Say
) -> dict[str, PageResult]:
    """Return the results of the pages that need no run, by name, and report them."""
    results = {}
    for page in pages:
        try:
            result = stored_result(page, places[page.docname])
        except PageRefused as refused:
            reason = str(refused).splitlines()[0]
            say(page.docname, f"its stored run is not used; executed again ({reason})")
            continue
        if result is not None:
            results[page.docname] = result
            say(page.docname, result.status)
    return results
