"""Execute one page in a clean kernel, and put it into the store if it did not fail."""

import asyncio
import re
import tempfile
import threading
import time
import uuid
from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import nbclient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from nbformat import NotebookNode

from robo_genesis.core import project
from robo_genesis.core.text import ended
from robo_genesis.pipeline.command import ANSI

from . import kernels, results
from .book import Page, code_digest
from .page_folder import PageRefused, find_bundle, write_page
from .results import Failure, PageResult

# What a warning names in the place of a file: a temporary one with the number of the
# process.
CELL_FILE = re.compile(rf"{re.escape(tempfile.gettempdir())}/ipykernel_\d+/\d+\.py")
# What a terminal overwrites in a line, after which a carriage return goes on.
OVERWRITTEN = re.compile(r"^.*\r(?=[^\r\n])|\r+(?=\n)", re.MULTILINE)


@dataclass(slots=True, eq=False)
class PageRun:
    """One run of one page.

    `place` is the page's folder in the store; `scratch` is a temporary folder; `log` is
    the file that gets what cells and kernel write; `timeout` is in seconds, for one
    cell; `expected` is how many seconds it will take, about.

    `cell` is the number of the code cell that runs, from 1; 0 while the kernel starts.
    The page `waits` before its first cell that must run alone until `turn` is set, and
    is `alone` from there on. `begin` is a time of the monotonic clock [s], later by the
    time for which the page waited.
    """

    page: Page
    place: Path
    scratch: Path
    log: Path
    timeout: int
    environment: Mapping[str, str]
    expected: float
    begin: float = field(default_factory=time.monotonic)
    cell: int = 0
    alone: bool = False
    waits: bool = False
    turn: threading.Event = field(default_factory=threading.Event)
    kernel: kernels.CleanKernelManager | None = None

    @property
    def state(self) -> str:
        """Cell and elapsed time of the run."""
        number = f"cell {self.cell} of {len(self.page.code.sources)}"
        cell = (number if self.cell else "kernel starts") + " waits" * self.waits
        return f"{cell}, {self.elapsed:.0f} s"

    @property
    def elapsed(self) -> float:
        """How long it runs [s]."""
        return time.monotonic() - self.begin

    def execute(self, on_cell: Callable[[], None]) -> PageResult:
        """Execute the page in an empty temporary folder; store it unless it failed.

        Args:
            on_cell: called before the cell after those that compile first, and when a
                cell waits.
        """
        with (
            tempfile.TemporaryDirectory(dir=self.scratch) as folder,
            self.log.open("wb", buffering=0) as log,
        ):
            seconds, failure = self._execute(Path(folder), log, on_cell)
        status = "failed" if failure else "executed"
        return PageResult(self.page, status, self.place, seconds, failure, self.log)

    def _execute(
        self, folder: Path, log: BinaryIO, on_cell: Callable[[], None]
    ) -> tuple[float, Failure | None]:
        """Return the seconds that the run took, without waiting, and why it failed."""
        home, work, outputs = folder / "home", folder / "work", folder / "outputs"
        for place in (home, work, outputs):
            place.mkdir()
        self.kernel = kernel = kernels.CleanKernelManager(home)
        notebook = deepcopy(self.page.notebook)
        begins: dict[int, float] = {}
        seconds: list[float] = []

        def cell_starts(cell: NotebookNode, cell_index: int) -> None:
            self.cell = results.cell_number(notebook, cell_index)
            if self.cell == self.page.compiles_first + 1 > 1:
                on_cell()
            if self.cell == self.page.alone:
                asked = time.monotonic()
                self.alone = self.waits = True
                on_cell()
                self.turn.wait()
                self.begin += time.monotonic() - asked
            kernel.busy = True
            begins[cell_index] = time.monotonic()

        def cell_ends(
            cell: NotebookNode, cell_index: int, execute_reply: object
        ) -> None:
            kernel.busy = False
            seconds.append(round(time.monotonic() - begins[cell_index], 3))

        own = {
            project.RUN_ID: uuid.uuid4().hex,
            project.OUTPUTS_DIR: str(outputs),
            project.PAGE_SHA256: code_digest(self.page),
            project.PAGE_IMPORTS: " ".join(self.page.code.imports),
        }
        self.begin, error = time.monotonic(), None
        client = LoggingClient(
            notebook,
            km=kernel,
            timeout=notebook.metadata.get("execution", {}).get("timeout", self.timeout),
            extra_arguments=kernels.ARGUMENTS,
            record_timing=False,
            on_cell_execute=cell_starts,
            on_cell_executed=cell_ends,
        )
        client.page_log = log
        try:
            # The engine's compiled parts write past Python: to the log as well.
            kernel_run = client.async_execute(
                cleanup_kc=True,
                env=kernels.clean_environment(home, {**self.environment, **own}),
                cwd=str(work),
                stdout=log,
                stderr=log,
            )
            asyncio.run(kernel_run)
        except Exception as caught:  # also a dead kernel, or one that does not start
            error = caught
        elapsed = time.monotonic() - self.begin
        left = outputs / str(self.page.lesson) / str(self.page.page)
        if failure := self._failure(notebook, error, list(begins), left):
            return elapsed, failure
        try:
            write_page(self.place, self.page, notebook, left, elapsed, seconds)
        except (PageRefused, OSError, RuntimeError, ValueError) as caught:
            return elapsed, Failure(
                "NotStored", f"the executed page cannot be stored: {caught}"
            )
        return elapsed, None

    def _failure(
        self,
        notebook: NotebookNode,
        error: Exception | None,
        started: list[int],
        left: Path,
    ) -> Failure | None:
        """Return why the page failed, None if it did not."""
        if error is None:
            wrong = results.unexpected_outcome(self.page, notebook)
            if wrong or not self.page.declares_bundle or find_bundle(left):
                return wrong
            return Failure(
                "BundleMissing",
                "the front matter declares a bundle, but the run left no "
                f"{self.page.lesson}/{self.page.page}/<backend>/manifest.json. Write it with "
                "page.finish, or remove `robo_genesis` from the front matter.",
            )
        name, message = type(error).__name__, str(error)
        if isinstance(error, CellExecutionError):
            name, message = error.ename, error.evalue
        elif isinstance(error, CellTimeoutError):
            message = message.splitlines()[0]
        elif isinstance(error, DeadKernelError) and self.kernel and self.kernel.process:
            message += f" with {ended(self.kernel.process.wait())}"
        if not started:
            return Failure(name, message)
        return results.at_cell(
            self.page, started[-1], name, message, notebook.cells[started[-1]]
        )


class LoggingClient(nbclient.NotebookClient):
    """Writes what cells print to the page's log.

    Printed text loses its colours: a plain `gs.init` writes those of a dark terminal.
    It becomes one text for each stream, because kernels flush at random moments, with
    the last state of each line. Text far beyond the limit is dropped, so that no loop
    fills memory and disk; then the page is refused.
    """

    page_log: BinaryIO

    def _cleanup_kernel(self) -> None:
        """Do nothing when Python exits: the build has ended its kernels."""

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
        self.page_log.write(text.encode("utf8", errors="replace"))
        for out in cell.outputs:
            if (
                out.get("name") == msg["content"]["name"]
                and not self.clear_before_next_output
            ):
                out.text = OVERWRITTEN.sub("", out.text + text)
                return out
        msg["content"]["text"] = OVERWRITTEN.sub("", text)
        output = super().process_message(msg, cell, cell_index)
        if [out.get("name") for out in cell.outputs[-2:]] == ["stderr", "stdout"]:
            cell.outputs[-2:] = cell.outputs[:-3:-1]  # their order is random
        return output
