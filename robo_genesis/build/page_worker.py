"""Execute one page in a process of its own, and judge what came of it."""

import logging
import os
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path

from jupyter_cache.base import ProjectNb
from jupyter_cache.executors.basic import ExecutionWorkerTempMProc, ProcessData
from jupyter_cache.executors.utils import ExecutionResult, single_nb_execution
from nbclient.exceptions import CellExecutionError, CellTimeoutError
from nbformat import NotebookNode

from robo_genesis.build.kernels import (
    ARGUMENTS,
    CleanKernelManager,
    clean_environment,
    die_with_parent,
)
from robo_genesis.build.page_cache import outputs_folder
from robo_genesis.build.page_results import (
    Failure,
    at_cell,
    last_lines,
    last_log_lines,
    missing_bundle,
    unexpected_outcome,
)
from robo_genesis.core.project import ROOT
from robo_genesis.lessons.book_pages import Page


@dataclass(frozen=True, slots=True)
class PageRun:
    """One run of one page: what its worker process needs to know.

    `folder` is the cache folder of the fingerprint; `scratch` is temporary, and goes with the build
    even where the worker is killed.
    """

    page: Page
    run_id: str
    folder: Path
    scratch: Path
    data: ProcessData
    environment: Mapping[str, str]


class PageFailed(Exception):  # noqa: N818 - it reports a page, it is no error of this program
    """Carries a failure through jupyter-cache, which then does not store the page."""

    def __init__(self, failure: Failure):
        super().__init__(f"{failure.error}: {failure.message}")
        self.failure = failure


class PageWorker(ExecutionWorkerTempMProc):
    """Executes one page in an empty temporary folder and stores it if nothing contradicts it."""

    def __init__(self, run: PageRun):
        self.run = run
        self.started: list[int] = []
        self.begin = 0.0
        self.seconds: list[float] = []
        self.failure: Failure | None = None

    @property
    def logger(self) -> logging.Logger:
        """Return the logger of this module: failures are reported, not logged."""
        return logging.getLogger(__name__)

    def execute(self, project_nb: ProjectNb, data: ProcessData) -> ExecutionResult:
        """Execute a page; called by jupyter-cache, which stores the result unless it has `err`."""
        notebook = project_nb.nb
        own = notebook.metadata.setdefault("robo_genesis", NotebookNode())
        own["run_id"] = self.run.run_id
        begin = time.monotonic()
        with tempfile.TemporaryDirectory(dir=self.run.scratch) as folder:
            try:
                result = single_nb_execution(
                    notebook,
                    cwd=folder,
                    timeout=data.timeout,
                    allow_errors=False,
                    kernel_manager_class=CleanKernelManager,
                    extra_arguments=ARGUMENTS,
                    on_cell_execute=self._cell_starts,
                    on_cell_executed=self._cell_ends,
                )
            except Exception as error:  # a dead kernel, or none that starts: a failed page, too
                result = ExecutionResult(notebook, folder, time.monotonic() - begin, err=error)
        own["cell_seconds"] = self.seconds
        self.failure = self._judge(notebook, result.err)
        result.err = PageFailed(self.failure) if self.failure else None
        return result

    def _cell_starts(self, cell: NotebookNode, cell_index: int) -> None:
        CleanKernelManager.busy = True
        self.started.append(cell_index)
        self.begin = time.monotonic()

    def _cell_ends(self, cell: NotebookNode, cell_index: int, execute_reply: object) -> None:
        CleanKernelManager.busy = False
        self.seconds.append(round(time.monotonic() - self.begin, 3))

    def _judge(self, notebook: NotebookNode, error: Exception | None) -> Failure | None:
        """Return why the page failed, None if it did not."""
        if error is None:
            outputs = outputs_folder(self.run.folder)
            return unexpected_outcome(notebook, notebook) or missing_bundle(
                outputs, self.run.page, self.run.run_id
            )
        name, message = type(error).__name__, str(error)
        if isinstance(error, CellExecutionError):
            name, message = error.ename, error.evalue
        elif isinstance(error, CellTimeoutError):
            message = message.splitlines()[0]
        if not self.started:
            return Failure(name, message)
        last = self.started[-1]
        return at_cell(notebook, last, name, message, last_log_lines(notebook, last))


def capture_file_descriptors(path: Path) -> Path:
    """Send what this process and its kernel write past Python to a file, and return the file.

    The engine's compiled parts do so: it would stand among the build's progress lines, and a crash
    would take its last words along.
    """
    target = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    for descriptor in (1, 2):
        os.dup2(target, descriptor)
    return path


def work(run: PageRun, connection: Connection) -> None:
    """Execute one page in this process and send back seconds and failure.

    Args:
        run: what to execute.
        connection: takes one pair; a process that ends without sending it has failed, too.
    """
    die_with_parent(run.scratch)
    logging.getLogger(__name__).addHandler(logging.NullHandler())
    logging.getLogger(__name__).propagate = False
    runtime = Path(tempfile.mkdtemp(dir=run.scratch))
    environment = clean_environment(run.folder / "home", runtime, ROOT, run.environment)
    os.environ.clear()
    os.environ.update(environment)
    raw = capture_file_descriptors(runtime / "raw.log")
    worker = PageWorker(run)
    begin = time.monotonic()
    code, _ = worker(run.data)
    failure = worker.failure
    if code and failure is None:
        failure = Failure("CacheError", "jupyter-cache could not read or store the page.")
    if failure:
        failure = replace(failure, log=failure.log + last_lines(raw.read_text(errors="replace")))
    connection.send((time.monotonic() - begin, failure))
