"""Execute the pages' code cells in clean kernels, in parallel, and keep them in the store."""

import multiprocessing
import os
import tempfile
import time
import uuid
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import inf
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.text import ended
from robo_genesis.pipeline.command import TIMEOUT
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.folder import OUTPUTS, PageRefused, Record
from robo_genesis.pipeline.pages.kernels import (
    interrupts_blocked,
    kill_with_descendants,
)
from robo_genesis.pipeline.pages.results import Failure, PageResult, Status, find_bundle
from robo_genesis.pipeline.pages.store import failed_mark, last_record, stored_result
from robo_genesis.pipeline.pages.worker import PageRun, work


@dataclass(slots=True)
class Underway:
    """One page that runs.

    `cells` is the number of its code cells and `cell` the one that runs, from 1; 0
    while the kernel starts. It `waits` before its first cell that must run alone, and
    is `alone` from there on. `last` is its last stored record, `log` the engine's log.
    Times are of the monotonic clock [s].
    """

    name: str
    cells: int
    alone: bool = False
    waits: bool = False
    last: Record | None = None
    log: Path | None = None
    begin: float = field(default_factory=time.monotonic)
    cell: int = 0

    def started(self) -> str:
        """Return what the line at its start says."""
        expected = f", about {self.last.seconds:.0f} s" if self.last else ""
        followed = f"; its log: {self.log}" if self.log else ""
        return f"started: {self.cells} cells{expected}{followed}"

    def state(self, now: float) -> str:
        """Return cell, elapsed time and estimated remaining time."""
        cell = f"cell {self.cell} of {self.cells}" if self.cell else "kernel starts"
        cell += " waits" if self.waits else ""
        elapsed = now - self.begin
        left = self.last.seconds - elapsed if self.last else 0.0
        rest = (
            f", ~{left:.0f} s left"
            if left > 0
            else ", longer than last time" * (left < 0)
        )
        return f"{cell}, {elapsed:.0f} s{rest}"


class Lines:
    """Reports pages as lines: each start and end, and now and then how far the pages are."""

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

    def show(self, pages: Sequence[Underway]) -> None:
        """Report the running pages, if it is time."""
        if pages and self.pause() == 0:
            now = time.monotonic()
            states = "; ".join(f"{page.name}: {page.state(now)}" for page in pages)
            self.say(f"{len(pages)} running: {states}", "")


# The workers that run: process, run and how far it is, by the connection of its
# messages.
Running = dict[Any, tuple[Any, PageRun, Underway]]


def execute_pages(
    pages: Sequence[Page],
    places: Mapping[str, Path],
    *,
    reuse: bool = True,
    jobs: int = 1,
    timeout: int = TIMEOUT,
    environment: Mapping[str, str] | None = None,
    logs: Path | None = None,
    report: Lines | None = None,
    accept: Callable[[PageResult], bool] = lambda result: True,
) -> list[PageResult]:
    """Execute the pages that the store does not have yet; try all of them.

    Those whose last run with this engine failed start first, then the longest. From its
    first cell tagged `alone`, a page runs when no other does; it starts last. If no
    kernel is compiled yet, the first lab starts first, and until it ends only pages
    with kernels of their own run beside it: the engine saves kernels when a page ends,
    so others would compile the same ones.

    A `multiprocessing.Pool` waits for ever when a worker is killed, and leaves kernels
    on Ctrl-C.

    Args:
        pages: the pages of the book.
        places: where the store has each page, or will have it; see `page_store.places`.
            A page that fails leaves its place as it is.
        reuse: whether a page that the store has is not executed again.
        jobs: how many pages run at once.
        timeout: seconds for one cell; a page's front matter may set another.
        environment: variables for the kernels.
        logs: the folder that keeps, for each page, a file with all that its last run
            wrote. By default it is not kept.
        report: gets each event, and shows how far the running pages are; by default
            nothing is shown.
        accept: called once for each page that was executed and did not fail, after the
            next page started; returns whether the page counts as one that did not fail.

    Returns:
        One result for each page, in the order of `pages`.

    Raises:
        OSError: the store cannot be used.
    """
    report, environment = report or Lines(), environment or {}
    results = _reused(pages, places, report) if reuse else {}
    last = {
        page.docname: last_record(places[page.docname].parents[1], page)
        for page in pages
    }
    waiting = [page for page in pages if page.docname not in results]
    failed = [
        page.docname for page in waiting if failed_mark(places[page.docname]).exists()
    ]
    labs = [page for page in waiting if page.page == "lab" and not page.alone]
    waiting = in_order(waiting, last, failed)
    first = []
    if labs and project.nothing_compiled(environment):
        first = [
            labs[0],
            *(page for page in waiting if page.own_kernels and not page.alone),
        ]
        waiting.sort(
            key=lambda page: first.index(page) if page in first else len(first)
        )
    for folder in [
        *(places[page.docname].parent for page in waiting),
        *([logs] if logs else []),
    ]:
        folder.mkdir(parents=True, exist_ok=True)  # fails before any run
    running: Running = {}
    ended: list[PageResult] = []
    with tempfile.TemporaryDirectory(prefix="robo-") as scratch:
        own = Path(scratch)
        try:
            while waiting or running or ended:
                while (
                    waiting
                    and (waiting[0] in first or not first)
                    and _room(running, jobs)
                ):
                    page = waiting.pop(0)
                    place, cells = places[page.docname], len(page.code.sources)
                    log = (logs or own) / f"{place.parent.name}.log"
                    run = PageRun(
                        page, uuid.uuid4().hex, place, own, log, timeout, environment
                    )
                    before, kept = last[page.docname], log if logs else None
                    underway = Underway(page.docname, cells, last=before, log=kept)
                    report.say(page.docname, underway.started())
                    _start(run, underway, running)
                for done in ended:
                    mark = failed_mark(done.folder)
                    if done.failure or not accept(done):
                        mark.touch()
                    else:
                        mark.unlink(missing_ok=True)
                ended = []
                if not running:
                    continue
                _let_one_go_on(
                    running
                )  # after `accept`, which would disturb what it measures
                for connection in wait(list(running), timeout=report.pause()):
                    result = _receive(connection, *running[connection])
                    if result is None:
                        continue
                    del running[connection]
                    first = [] if result.page in first[:1] else first
                    results[result.page.docname] = result
                    report.say(result.page.docname, result.ended)
                    ended.append(result)
                report.show([underway for *_, underway in running.values()])
        finally:
            kill_with_descendants(process.pid for process, *_ in running.values())
    return [results[page.docname] for page in pages]


def kernel_environment(
    root: Path, cache: Path, command: str, **settings: str
) -> dict[str, str]:
    """Return the variables that every kernel of a command gets.

    Args:
        root: the checkout.
        cache: the folder of the caches.
        command: the command that bundles name.
        settings: variables that replace those of this process.
    """
    return {
        **project.engine_cache_environment(root, cache),
        **project.environment_contract({**os.environ, **settings}),
        project.COMMAND: command,
    }


def in_order(
    pages: Iterable[Page],
    last: Mapping[str, Record | None],
    failed: Collection[str] = (),
) -> list[Page]:
    """Return pages in the order in which they start: the longest first, those with `alone` last.

    Args:
        pages: the pages to execute.
        last: the record of the last execution of each page, by name. Pages without one
            come before the others, and among them those with the most cells.
        failed: the names of pages that come before all others.
    """
    seconds = {name: record.seconds for name, record in last.items() if record}

    def sooner(page: Page) -> tuple[bool, bool, float, int]:
        name = page.docname
        return (
            name not in failed,
            bool(page.alone),
            -seconds.get(name, inf),
            -len(page.code.sources),
        )

    return sorted(pages, key=sooner)


def _room(running: Running, jobs: int) -> bool:
    """Whether one more page may run: fewer than `jobs` do, and none is alone or waits for that."""
    return len(running) < jobs and not any(
        underway.alone for *_, underway in running.values()
    )


def _let_one_go_on(running: Running) -> None:
    """Let a page go on to the cells that run alone, if all pages that run wait for that."""
    if running and all(underway.waits for *_, underway in running.values()):
        connection, (_, _, underway) = next(iter(running.items()))
        underway.waits = False
        with suppress(OSError):  # it died; that is noticed where its end is received
            connection.send(True)


def _reused(
    pages: Sequence[Page], places: Mapping[str, Path], report: Lines
) -> dict[str, PageResult]:
    """Return the results of the pages that need no run, by name, and report them."""
    results = {}
    for page in pages:
        try:
            result = stored_result(page, places[page.docname])
        except PageRefused as refused:
            reason = str(refused).splitlines()[0]
            report.say(
                page.docname, f"its stored run is not used; executed again ({reason})"
            )
            continue
        if result is not None:
            results[page.docname] = result
            report.say(page.docname, result.ended if result.failure else result.status)
    return results


def _start(run: PageRun, underway: Underway, running: Running) -> None:
    """Start the worker process of one page and enter it in `running`."""
    # Spawned, not forked: the worker inherits neither threads nor open databases.
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe()
    process = context.Process(target=work, args=(run, sender))
    with (
        interrupts_blocked()
    ):  # a Ctrl-C from here on finds the worker among the running
        process.start()
        running[receiver] = process, run, underway
    sender.close()


def _receive(
    connection: Any, process: Any, run: PageRun, underway: Underway
) -> PageResult | None:
    """Return the result of a page whose worker sent it, or died without sending it.

    It is None if a cell starts.
    """
    try:
        received = connection.recv()
        if isinstance(received, int):
            underway.cell = received
            if received == run.page.alone:
                underway.alone = underway.waits = True
            return None
        seconds, failure = received
    except (EOFError, ConnectionError):
        process.join()
        cell = f" in cell {underway.cell}" if underway.cell else ""
        message = f"the worker process ended{cell} with {ended(process.exitcode)}"
        seconds, failure = 0.0, Failure("WorkerDied", message)
    process.join()
    connection.close()
    status: Status = "failed" if failure else "executed"
    bundle = None if failure else find_bundle(run.place / OUTPUTS, run.run_id)
    return PageResult(
        run.page, status, seconds, run.run_id, bundle, failure, run.place, underway.log
    )
