"""Execute one page in a process of its own, and put it into the store if it did not fail."""

import os
import re
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import nbclient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from nbformat import NotebookNode

from robo_genesis.core.project import (
    OUTPUTS_DIR,
    PAGE_IMPORTS,
    PAGE_SHA256,
    ROOT,
    RUN_ID,
)
from robo_genesis.core.text import ended
from robo_genesis.pipeline.command import ANSI
from robo_genesis.pipeline.pages import kernels, results
from robo_genesis.pipeline.pages.book import Page, code_digest
from robo_genesis.pipeline.pages.folder import PageRefused, write_page
from robo_genesis.pipeline.pages.opened import unkeyed_files
from robo_genesis.pipeline.pages.results import Failure
from robo_genesis.pipeline.pages.sources import PACKAGE, Tree


@dataclass(frozen=True, slots=True)
class PageRun:
    """One run of one page: what its worker process needs to know.

    `place` is the page's folder in the store; `scratch` is temporary, and is removed
    with the build even where the worker is killed; `log` is the file that gets what
    cells and kernel write; `timeout` is in seconds, for one cell.
    """

    page: Page
    run_id: str
    place: Path
    scratch: Path
    log: Path
    timeout: int
    environment: Mapping[str, str]

    @property
    def outputs(self) -> Path:
        """The folder that the contract names to the page."""
        return self.scratch / self.run_id

    @property
    def left(self) -> Path:
        """The folder of the files that the page leaves."""
        return self.outputs / str(self.page.lesson) / str(self.page.page)


def work(run: PageRun, connection: Connection) -> None:
    """Execute one page in this process and send back its progress, then seconds and failure.

    Args:
        run: what to execute.
        connection: takes the number of each code cell that starts, counted from 1, and
            in the end one pair; a process that ends without sending it has failed as
            well. The first cell that must run alone waits until something is received.
    """

    def starts(cell: int) -> None:
        connection.send(cell)
        if cell == run.page.alone:
            connection.recv()

    kernels.die_with_parent(run.scratch)
    home = Path(tempfile.mkdtemp(dir=run.scratch))
    own = {
        RUN_ID: run.run_id,
        OUTPUTS_DIR: str(run.outputs),
        PAGE_SHA256: code_digest(run.page),
        PAGE_IMPORTS: " ".join(run.page.code.imports),
    }
    environment = kernels.clean_environment(home, ROOT, {**run.environment, **own})
    os.environ.clear()
    os.environ.update(environment)
    # The engine's compiled parts write past Python: to a file, because the build prints
    # its progress here, and because a crash would lose the last lines.
    descriptor = os.open(
        run.log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o644
    )
    for standard in (1, 2):
        os.dup2(descriptor, standard)
    begin = time.monotonic()
    failure = execute_page(run, starts)
    if failure:
        written = run.log.read_text("utf8", errors="replace")
        failure = replace(failure, log=results.last_lines(written))
    connection.send((time.monotonic() - begin, failure))


# What a warning names in the place of a file: a temporary one with the number of the
# process.
CELL_FILE = re.compile(rf"{re.escape(tempfile.gettempdir())}/ipykernel_\d+/\d+\.py")


class LoggingClient(nbclient.NotebookClient):
    """Writes what cells print to this process's standard output, which is the page's log.

    Printed text loses its colours: a plain `gs.init` writes those of a dark terminal.
        It becomes
    one text for each stream, because kernels flush at random moments, with the last
    state of each line. nbclient does the same, in a time that grows with the square of
    a line's length. Text far beyond the limit is dropped, so that no loop fills memory
    and disk; then the page is refused.
    """

    def process_message(
        self, msg: dict[str, Any], cell: NotebookNode, cell_index: int
    ) -> NotebookNode | None:
        """Keep one message of the kernel in the notebook, and write its text."""
        if msg["msg_type"] != "stream":
            return super().process_message(msg, cell, cell_index)
        if (
            sum(len(out.get("text", "")) for out in cell.outputs)
            > 10 * results.MOST_LETTERS
        ):
            return None
        text = CELL_FILE.sub("cell", ANSI.sub("", msg["content"]["text"]))
        os.write(1, text.encode("utf8", errors="replace"))
        for out in cell.outputs:
            if (
                out.get("name") == msg["content"]["name"]
                and not self.clear_before_next_output
            ):
                out.text = last_states(out.text + text)
                return out
        msg["content"]["text"] = last_states(text)
        found = super().process_message(msg, cell, cell_index)
        if [out.get("name") for out in cell.outputs[-2:]] == ["stderr", "stdout"]:
            cell.outputs[-2:] = cell.outputs[:-3:-1]  # their order is random
        return found


def last_states(text: str) -> str:
    """Return a text with each line as a terminal shows it, after its last carriage return."""
    lines = (
        [state for state in line.split("\r") if state] for line in text.split("\n")
    )
    return "\n".join(
        states[-1] if states else "" for states in lines
    ) + "\r" * text.endswith("\r")


def execute_page(run: PageRun, on_cell: Callable[[int], None]) -> Failure | None:
    """Execute a page in an empty temporary folder; store it, or return why it failed.

    Args:
        run: what to execute.
        on_cell: called with the number of each code cell that starts.
    """
    notebook, error = run.page.notebook, None
    begin = time.monotonic()
    begins: dict[int, float] = {}  # of each cell that started, by its index
    seconds: list[float] = []

    def cell_starts(cell: NotebookNode, cell_index: int) -> None:
        nonlocal begin
        asked = time.monotonic()
        on_cell(
            [each.cell_type for each in notebook.cells[: cell_index + 1]].count("code")
        )
        kernels.CleanKernelManager.busy = True
        begins[cell_index] = time.monotonic()
        begin += (
            begins[cell_index] - asked
        )  # waiting for other pages is not part of the run

    def cell_ends(cell: NotebookNode, cell_index: int, execute_reply: object) -> None:
        kernels.CleanKernelManager.busy = False
        seconds.append(round(time.monotonic() - begins[cell_index], 3))

    with tempfile.TemporaryDirectory(dir=run.scratch) as folder:
        try:
            LoggingClient(
                notebook,
                resources={"metadata": {"path": folder}},
                timeout=notebook.metadata.get("execution", {}).get(
                    "timeout", run.timeout
                ),
                kernel_manager_class=kernels.CleanKernelManager,
                extra_arguments=kernels.ARGUMENTS,
                record_timing=False,
                on_cell_execute=cell_starts,
                on_cell_executed=cell_ends,
            ).execute()
        except (
            Exception
        ) as caught:  # a dead kernel, or none that starts, is a failed page as well
            error = caught
    elapsed = time.monotonic() - begin
    if failure := _failure(run, error, list(begins)):
        return failure
    notebook.metadata.setdefault("robo_genesis", NotebookNode())["run_id"] = run.run_id
    try:
        if failure := _unkeyed(run):
            return failure
        write_page(
            run.place, run.page, notebook, run.left, run.run_id, elapsed, seconds
        )
    except (PageRefused, OSError, RuntimeError, ValueError) as caught:
        return Failure("NotStored", f"the executed page cannot be stored: {caught}")
    return None


def _unkeyed(run: PageRun) -> Failure | None:
    """Return the failure of a page that read files on which no key depends."""
    tree = Tree()
    modules = tree.behind(run.page).values()
    data = (ROOT / PACKAGE / name for name in tree.data_for(modules))
    names = unkeyed_files(
        [*modules, *data, ROOT / "pyproject.toml", ROOT / "requirements.lock"]
    )
    if not names:
        return None
    return Failure(
        "FileNotKeyed",
        f"no key covers what the page read (files: {len(names)}): {', '.join(names[:20])}. "
        "It would not be executed again if they changed. "
        "Valid are files of its lesson's folder, of imported modules and packages, and its own. "
        f"Move them into {PACKAGE}/lessons/{run.page.lesson or '…'}.",
    )


def _failure(
    run: PageRun, error: Exception | None, started: list[int]
) -> Failure | None:
    """Return why a page failed, None if it did not."""
    notebook = run.page.notebook
    if error is None:
        return results.unexpected_outcome(run.page, notebook) or results.missing_bundle(
            run.left, run.page, run.run_id
        )
    name, message = type(error).__name__, str(error)
    if isinstance(error, CellExecutionError):
        name, message = error.ename, error.evalue
    elif isinstance(error, CellTimeoutError):
        message = message.splitlines()[0]
    elif isinstance(error, DeadKernelError) and (
        process := kernels.CleanKernelManager.process
    ):
        message += f" with {ended(process.wait())}"
    if not started:
        return Failure(name, message)
    last = started[-1]
    return results.at_cell(run.page, last, name, message, notebook.cells[last])
