"""A process that loads Sphinx while the pages are executed, and then renders a book once."""

import importlib
import json
import multiprocessing
import os
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.pipeline.command import ANSI, collect_rarely, end_with_parent

if TYPE_CHECKING:  # the process is started before the packages of Jupyter are loaded
    from robo_genesis.pipeline.pages.built import BuiltPages

COMPLAINT = re.compile(r"WARNING|ERROR|CRITICAL|[Ee]rror:")
LOG = "render.log"
"""Its name in the folder of the caches."""
HTML = "_build/html"
"""The folder of the pages in the folder that Sphinx gets."""
OPTIONS = ("-n", "-W", "--keep-going", "--builder", "html")


class RenderError(ProjectError):
    """Sphinx failed or warned; the message holds its complaints and the place of the log."""


class SphinxProcess:
    """The process; as a context manager, it is ended when the context is left."""

    def __init__(self, book: Path, log: Path):
        """Start it.

        Args:
            book: folder with `_config.yml`, `_toc.yml` and the pages.
            log: file for the output of Sphinx; it is written only during the render, so that a
                process which waits for nothing does not disturb another build.
        """
        self.book, self.log = book, log
        self.process = subprocess.Popen(
            [sys.executable, "-m", __name__, str(book)],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True,
            preexec_fn=end_with_parent(),
        )  # fmt: skip

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.process.kill()
        self.process.communicate()

    def render(
        self, folder: Path, built: "BuiltPages", meanwhile: Callable[[], None] = lambda: None
    ) -> None:
        """Render the book; this can be done once.

        Args:
            folder: of Sphinx's output; its folder `HTML` gets the pages. What is there is taken
                for current, unless Sphinx finds it outdated.
            built: the executed pages.
            meanwhile: called while Sphinx works. What it raises ends Sphinx and is raised here.

        Raises:
            RenderError: Sphinx failed or gave a warning.
        """
        arguments = ["build", str(self.book), "--path-output", str(folder), *OPTIONS]
        variables = built.write(folder / "executed-pages.json")
        self.log.parent.mkdir(parents=True, exist_ok=True)
        self.log.write_text("Sphinx ended before it began.\n", "utf8")
        assert self.process.stdin is not None
        with suppress(BrokenPipeError), self.process.stdin as order:  # its status is reported below
            order.write(json.dumps([str(self.log), arguments, variables]))
        with self:  # nothing writes into the folder after an interrupt, or a refusal meanwhile
            meanwhile()
            self.process.wait()
        if self.process.returncode != 0 or not (folder / HTML / "index.html").is_file():
            raise RenderError(f"{complaints(self.log)}\nThe complete log is in {self.log}")


def complaints(log: Path) -> str:
    """Return the warnings and errors of a log, or its end where it names none."""
    lines = ANSI.sub("", log.read_text("utf8", errors="replace")).splitlines()
    found = list(dict.fromkeys(line for line in lines if COMPLAINT.search(line)))
    return "\n".join(found or lines[-20:])


def main() -> None:
    """Load Jupyter Book and the book's extensions, then wait for arguments and variables."""
    collect_rarely()
    import yaml
    from jupyter_book.cli.main import main as jupyter_book

    with suppress(Exception):  # Jupyter Book reports it
        config = yaml.safe_load(Path(sys.argv[1], "_config.yml").read_text("utf8"))
        for extension in config["sphinx"]["config"]["extensions"]:
            importlib.import_module(extension)
    if order := sys.stdin.readline():
        log, arguments, variables = json.loads(order)
        with open(log, "w") as stream:
            for output in (1, 2):
                os.dup2(stream.fileno(), output)
        os.environ.update(variables)
        status: object = 0
        try:
            jupyter_book(arguments)
        except SystemExit as end:
            status = end.code
        sys.stdout.flush()
        sys.stderr.flush()
        for child in multiprocessing.active_children():  # the sitemap's, which ends at a usual exit
            child.kill()
        os._exit(0 if status in (None, 0) else 1)  # freeing all doctrees takes half a second


if __name__ == "__main__":
    main()
