"""Execute the pages' code cells in clean kernels, in parallel, and keep them in the page cache."""

import multiprocessing
import os
import shutil
import tempfile
import uuid
from collections.abc import Callable, Mapping, Sequence
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from robo_genesis.build.command import TIMEOUT
from robo_genesis.build.kernels import interrupts_blocked, kill_with_descendants
from robo_genesis.build.page_cache import cached_results, outputs_folder, usable
from robo_genesis.build.page_results import Failure, PageResult, Status, find_bundle
from robo_genesis.build.page_worker import PageRun, work
from robo_genesis.core import project
from robo_genesis.lessons.book_pages import Page

HEARTBEAT = 30.0
Running = dict[Any, tuple[Any, PageRun]]
"""The worker process and the run of each page that runs, by the connection of its result."""


def execute_pages(
    pages: Sequence[Page],
    folder: Path,
    *,
    jobs: int = 1,
    timeout: int = TIMEOUT,
    environment: Mapping[str, str] | None = None,
    on_progress: Callable[[str, str], None] = lambda what, event: None,
    heartbeat: float = HEARTBEAT,
) -> list[PageResult]:
    """Execute the pages that this cache folder does not hold yet; try all of them.

    jupyter-cache's own parallel executor maps a `multiprocessing.Pool`, which waits for ever when a
    worker is killed for memory, reports nothing before the last page, and leaves kernels behind on
    Ctrl-C.

    Args:
        pages: the pages of the book.
        folder: the cache folder of their fingerprint; holds `notebooks`, `outputs` and `home`.
        jobs: how many pages run at once.
        timeout: seconds for one cell; a page's front matter may set another.
        environment: variables for the kernels.
        on_progress: called with a page's name and an event, or with the running pages and "".
        heartbeat: seconds without an event after which the running pages are reported.

    Returns:
        One result for each page, in the order of `pages`.

    Raises:
        ProjectError: the cache folder cannot be used.
    """
    folder = folder.absolute()
    with usable(folder):
        results = cached_results(pages, folder)
    for result in results.values():
        on_progress(result.page.docname, result.status)
    waiting = [page for page in pages if page.docname not in results]
    running: Running = {}
    with tempfile.TemporaryDirectory(prefix="robo-") as scratch:
        try:
            while waiting or running:
                while waiting and len(running) < jobs:
                    page = waiting.pop(0)
                    on_progress(page.docname, "started")
                    run_id = prepare_outputs(page, outputs_folder(folder))
                    run = PageRun(page, run_id, folder, Path(scratch), timeout, environment or {})
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
        "ROBO_GENESIS_COMMAND": command,
    }


def prepare_outputs(page: Page, outputs: Path) -> str:
    """Remove the bundle of a page's last run and return a fresh run id."""
    outputs.mkdir(parents=True, exist_ok=True)
    if page.declares_bundle:
        shutil.rmtree(outputs / str(page.lesson) / str(page.page), ignore_errors=True)
        for partial in outputs.glob(f".{page.lesson}-{page.page}-*"):  # a killed run's bundle
            shutil.rmtree(partial, ignore_errors=True)
    return uuid.uuid4().hex


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
    bundle = None
    if run.page.declares_bundle and not failure:
        bundle = find_bundle(outputs_folder(run.folder), run.page, run.run_id)
    status: Status = "failed" if failure else "executed"
    return PageResult(run.page, status, seconds, run.run_id, bundle, failure)
