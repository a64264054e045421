"""Execute the pages' code cells in clean kernels, in parallel, and keep them in the store."""

import multiprocessing
import os
import tempfile
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from robo_genesis.build.command import TIMEOUT
from robo_genesis.build.kernels import interrupts_blocked, kill_with_descendants
from robo_genesis.build.page_folder import OUTPUTS, PageRefused
from robo_genesis.build.page_results import Failure, PageResult, find_bundle
from robo_genesis.build.page_store import last_seconds, stored_result
from robo_genesis.build.page_worker import PageRun, work
from robo_genesis.core import project
from robo_genesis.core.project import COMMAND
from robo_genesis.lessons.book_pages import Page

HEARTBEAT = 30.0
Running = dict[Any, tuple[Any, PageRun]]
"""The worker process and the run of each page that runs, by the connection of its result."""


def execute_pages(
    pages: Sequence[Page],
    places: Mapping[str, Path],
    *,
    reuse: bool = True,
    jobs: int = 1,
    timeout: int = TIMEOUT,
    environment: Mapping[str, str] | None = None,
    on_progress: Callable[[str, str], None] = lambda what, event: None,
    heartbeat: float = HEARTBEAT,
) -> list[PageResult]:
    """Execute the pages that the store does not have yet; try all of them, the longest first.

    A `multiprocessing.Pool` waits for ever when a worker is killed for memory, and leaves kernels
    behind on Ctrl-C.

    Args:
        pages: the pages of the book.
        places: where the store has each page, or will have it; see `page_store.places`. A page
            that fails leaves its place as it is.
        reuse: whether a page that the store has is not executed again.
        jobs: how many pages run at once.
        timeout: seconds for one cell; a page's front matter may set another.
        environment: variables for the kernels.
        on_progress: called with a page's name and an event, or with the running pages and "".
        heartbeat: seconds without an event after which the running pages are reported.

    Returns:
        One result for each page, in the order of `pages`.

    Raises:
        OSError: the store cannot be used.
    """
    results = _reused(pages, places, on_progress) if reuse else {}
    last = {page.docname: last_seconds(places[page.docname].parents[1], page) for page in pages}
    waiting = longest_first((page for page in pages if page.docname not in results), last)
    for page in waiting:
        places[page.docname].parent.mkdir(parents=True, exist_ok=True)  # fails before any run
    running: Running = {}
    with tempfile.TemporaryDirectory(prefix="robo-") as scratch:
        try:
            while waiting or running:
                while waiting and len(running) < jobs:
                    page = waiting.pop(0)
                    on_progress(page.docname, "started")
                    place, own = places[page.docname], Path(scratch)
                    run = PageRun(page, uuid.uuid4().hex, place, own, timeout, environment or {})
                    _start(run, running)
                ended = wait(list(running), timeout=heartbeat)
                if not ended:
                    names = ", ".join(run.page.docname for _, run in running.values())
                    on_progress(f"{len(running)} running: {names}", "")
                for connection in ended:
                    result = _receive(connection, *running[connection])
                    del running[connection]
                    results[result.page.docname] = result
                    on_progress(result.page.docname, f"{result.status} in {result.seconds:.0f} s")
        finally:
            kill_with_descendants(process.pid for process, _ in running.values())
    return [results[page.docname] for page in pages]


def kernel_environment(root: Path, cache: Path, command: str, **settings: str) -> dict[str, str]:
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
        COMMAND: command,
    }


def longest_first(pages: Iterable[Page], seconds: Mapping[str, float | None]) -> list[Page]:
    """Return pages in the order in which they start.

    Args:
        pages: the pages to execute.
        seconds: how long the last execution of each page took, by name. Pages with None come first.
    """

    def sooner(page: Page) -> float:
        known = seconds[page.docname]
        return float("-inf") if known is None else -known

    return sorted(pages, key=sooner)


def _reused(
    pages: Sequence[Page], places: Mapping[str, Path], on_progress: Callable[[str, str], None]
) -> dict[str, PageResult]:
    """Return the results of the pages that need no run, by name, and report them."""
    results = {}
    for page in pages:
        try:
            result = stored_result(page, places[page.docname])
        except PageRefused as refused:
            reason = str(refused).splitlines()[0]
            on_progress(page.docname, f"changed since it was stored; executed again ({reason})")
            continue
        if result is not None:
            results[page.docname] = result
            on_progress(page.docname, result.status)
    return results


def _start(run: PageRun, running: Running) -> None:
    """Start the worker process of one page and enter it in `running`."""
    # Spawned, not forked: the worker inherits neither threads nor open databases.
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=work, args=(run, sender))
    with interrupts_blocked():  # a Ctrl-C from here on finds the worker among the running
        process.start()
        running[receiver] = (process, run)
    sender.close()


def _receive(connection: Any, process: Any, run: PageRun) -> PageResult:
    """Return the result of a page whose worker sent it, or died without sending it."""
    try:
        seconds, failure = connection.recv()
    except EOFError:
        process.join()
        message = f"the worker process ended with status {process.exitcode}; out of memory?"
        seconds, failure = 0.0, Failure("WorkerDied", message)
    process.join()
    connection.close()
    if failure:
        return PageResult(run.page, "failed", seconds, run.run_id, failure=failure)
    bundle = find_bundle(run.place / OUTPUTS, run.run_id) if run.page.declares_bundle else None
    return PageResult(run.page, "executed", seconds, run.run_id, bundle, folder=run.place)
