"""Execute the pages' code cells in clean kernels, in parallel, through jupyter-cache."""

import logging
import multiprocessing
import shutil
import tempfile
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from jupyter_cache.base import JupyterCacheAbstract
from jupyter_cache.executors.base import ExecutorRunResult
from jupyter_cache.executors.basic import JupyterExecutorTempMproc, ProcessData

from robo_genesis.build.kernels import interrupts_blocked, kill_with_descendants
from robo_genesis.build.page_cache import (
    PageCache,
    cached_results,
    notebooks_folder,
    outputs_folder,
    usable,
)
from robo_genesis.build.page_results import Failure, PageResult, find_bundle
from robo_genesis.build.page_worker import PageRun, work
from robo_genesis.lessons.book_pages import Page, code_digest

TIMEOUT = 1500
HEARTBEAT = 30.0
READER = {"type": "plugin", "name": "myst_nb_md"}
Progress = Callable[[str, str], None]
Running = dict[Any, tuple[Any, PageRun]]


@dataclass(frozen=True, slots=True)
class Execution:
    """How pages are executed.

    `folder` is the cache folder of the pages' fingerprint, `jobs` the number of pages that run at
    once, `environment` goes to the kernels, `on_progress` is told a page and what happens to it,
    and what runs, where nothing happened for `heartbeat` seconds.
    """

    folder: Path
    jobs: int
    environment: Mapping[str, str]
    on_progress: Progress
    heartbeat: float = HEARTBEAT


class PageExecutor(JupyterExecutorTempMproc):
    """jupyter-cache's parallel executor with a limit of jobs, and kernels that die with it.

    The base class maps a `multiprocessing.Pool`, which waits for ever when a worker is killed for
    memory, reports nothing before the last page, and leaves kernels behind on Ctrl-C.
    """

    def __init__(
        self,
        cache: JupyterCacheAbstract,
        logger: logging.Logger | None = None,
        *,
        pages: Mapping[str, Page],
        execution: Execution,
    ):
        super().__init__(cache, logger)
        self.pages, self.execution = pages, execution
        self.results: dict[str, PageResult] = {}

    def run_and_cache(
        self,
        *,
        filter_uris: list[str] | None = None,
        filter_pks: list[int] | None = None,
        timeout: int | None = TIMEOUT,
        allow_errors: bool = False,
        force: bool = False,
        **kwargs: Any,
    ) -> ExecutorRunResult:
        """Execute the project's pages that the cache does not hold; see the base class."""
        waiting = [
            ProcessData(record.pk, record.uri, self.cache, timeout or TIMEOUT, allow_errors)
            for record in self.get_records(filter_uris, filter_pks, force=force)
        ]
        result = ExecutorRunResult()
        running: Running = {}
        with tempfile.TemporaryDirectory(prefix="robo-") as scratch:
            try:
                while waiting or running:
                    while waiting and len(running) < self.execution.jobs:
                        self._launch(waiting.pop(0), Path(scratch), running)
                    for connection in self._ended(running):
                        failure = self._finish(connection, *running[connection])
                        _, run = running.pop(connection)
                        (result.excepted if failure else result.succeeded).append(run.data.uri)
            finally:
                kill_with_descendants(process.pid for process, _ in running.values())
        return result

    def _ended(self, running: Running) -> list[Any]:
        """Return connections of workers that sent a result or died; say meanwhile what runs."""
        while not (ended := wait(list(running), timeout=self.execution.heartbeat)):
            names = ", ".join(run.page.docname for _, run in running.values())
            self.execution.on_progress(f"{len(running)} running: {names}", "")
        return ended

    def _launch(self, data: ProcessData, scratch: Path, running: Running) -> None:
        """Start the worker process of one page and enter it in `running`."""
        page, how = self.pages[data.uri], self.execution
        how.on_progress(page.docname, "started")
        outputs = outputs_folder(how.folder)
        run_id = prepare_outputs(page, outputs)
        own = {
            "ROBO_GENESIS_RUN_ID": run_id,
            "ROBO_GENESIS_OUTPUTS_DIR": str(outputs),
            "ROBO_GENESIS_PAGE_SHA256": code_digest(page),
        }
        run = PageRun(page, run_id, how.folder, scratch, data, {**how.environment, **own})
        # Spawned, not forked: neither threads nor open databases of the parent come along.
        context = multiprocessing.get_context("spawn")
        receiver, sender = context.Pipe(duplex=False)
        process = context.Process(target=work, args=(run, sender))
        with interrupts_blocked():  # a Ctrl-C from here on finds the worker among the running
            process.start()
            running[receiver] = (process, run)
        sender.close()

    def _finish(self, connection: Any, process: Any, run: PageRun) -> Failure | None:
        """Keep the result of one page and return its failure, if it failed."""
        seconds, failure = receive(connection, process)
        page, bundle = run.page, None
        if page.declares_bundle and not failure:
            bundle = find_bundle(outputs_folder(run.folder), page, run.run_id)
        result = PageResult(
            page, "failed" if failure else "executed", seconds, run.run_id, bundle, failure
        )
        self.results[page.docname] = result
        self.execution.on_progress(page.docname, f"{result.status} in {seconds:.0f} s")
        return failure


def prepare_outputs(page: Page, outputs: Path) -> str:
    """Remove the bundle of a page's last run and return a fresh run id."""
    outputs.mkdir(parents=True, exist_ok=True)
    if page.declares_bundle:
        shutil.rmtree(outputs / str(page.lesson) / str(page.page), ignore_errors=True)
        for partial in outputs.glob(f".{page.lesson}-{page.page}-*"):  # a killed run's bundle
            shutil.rmtree(partial, ignore_errors=True)
    return uuid.uuid4().hex


def receive(connection: Any, process: Any) -> tuple[float, Failure | None]:
    """Return what a worker sent, or the failure that it ended without a word."""
    try:
        seconds, failure = connection.recv()
    except EOFError:
        process.join()
        message = f"the worker process ended with status {process.exitcode}; out of memory?"
        seconds, failure = 0.0, Failure("WorkerDied", message)
    process.join()
    connection.close()
    return seconds, failure


def execute_pages(
    pages: Sequence[Page],
    folder: Path,
    *,
    jobs: int = 1,
    timeout: int = TIMEOUT,
    environment: Mapping[str, str] | None = None,
    on_progress: Progress = lambda what, event: None,
    heartbeat: float = HEARTBEAT,
) -> list[PageResult]:
    """Execute the pages that this cache folder does not hold yet; try all of them.

    Args:
        pages: the pages of the book.
        folder: the cache folder of their fingerprint; holds `notebooks`, `outputs` and `home`.
        jobs: how many pages run at once.
        timeout: seconds for one cell; a page's front matter may say less.
        environment: variables for the kernels.
        on_progress: called with a page's name and what happens to it, or with what runs and "".
        heartbeat: seconds without any event after which it is told what runs.

    Returns:
        One result for each page, in the order of `pages`.

    Raises:
        ProjectError: the cache folder cannot be used.
    """
    execution = Execution(folder.absolute(), jobs, environment or {}, on_progress, heartbeat)
    with usable(folder):
        results = _execute(pages, execution, timeout)
    return [results[page.docname] for page in pages]


def _execute(pages: Sequence[Page], execution: Execution, timeout: int) -> dict[str, PageResult]:
    """Return the results by page name: those that the cache holds, and those of a run now."""
    on_progress = execution.on_progress
    cache = PageCache(notebooks_folder(execution.folder))
    cached = cached_results(pages, cache, outputs_folder(execution.folder))
    for result in cached.values():
        on_progress(result.page.docname, result.status)
    waiting = {str(page.path.absolute()): page for page in pages if page.docname not in cached}
    for uri in waiting:
        cache.add_nb_to_project(uri, read_data=READER)
    executor = PageExecutor(cache, pages=waiting, execution=execution)
    executor.run_and_cache(filter_uris=list(waiting), timeout=timeout)
    return cached | executor.results
