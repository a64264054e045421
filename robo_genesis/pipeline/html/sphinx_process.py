"""A process that loads Sphinx while pages are executed or written, and then renders a book.

Each line of its input is an order in JSON: the folder of the output, variables, the
    pages to read
again, and whether it is the last. It answers with a line: the warnings and errors, none
    if the
render succeeded, and whether it ends, because Sphinx cannot build again after an
exception.
"""

import importlib
import io
import json
import multiprocessing
import os
import signal
import subprocess
import sys
import traceback
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.core.text import ended
from robo_genesis.pipeline.command import ANSI, collect_rarely, end_with_parent

if TYPE_CHECKING:  # the process is started before the packages of Jupyter are loaded
    from robo_genesis.pipeline.pages.page_index import PageIndex

LOG = "render.log"  # Its name in the folder of the caches
HTML = "_build/html"  # The folder of the pages in the folder that Sphinx gets
DOCTREES = "_build/.doctrees"
EXECUTED = (
    "executed-pages.json"  # The file in that folder which lists the executed pages
)


class SphinxProcess:
    """The process; as a context manager, it is ended when the context is left."""

    def __init__(self, book: Path, log: Path):
        """Start it.

        Args:
            book: folder with `_config.yml`, `_toc.yml` and the pages.
            log: file for the output of Sphinx; it is written only during a render, so
                that a process which waits for nothing does not disturb another build.
        """
        self.book, self.log = book, log
        self.process = subprocess.Popen(
            [sys.executable, "-m", __name__, str(book), str(log)],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
            preexec_fn=end_with_parent(),
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        """End the process and what it started: a child would keep the pipes open."""
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        for pipe in (self.process.stdin, self.process.stdout):
            with suppress(OSError):
                pipe.close()  # type: ignore[union-attr]
        self.process.wait()

    def render(
        self,
        folder: Path,
        built: "PageIndex",
        meanwhile: Callable[[], None] = lambda: None,
    ) -> None:
        """Render the book, and end the process.

        Args:
            folder: of Sphinx's output; its folder `HTML` gets the pages. What is there
                is taken for current, unless Sphinx finds it outdated.
            built: the executed pages.
            meanwhile: called while Sphinx works. What it raises ends Sphinx and is
                raised here.

        Raises:
            ProjectError: Sphinx failed or gave a warning.
        """
        self.order(folder, built.write(folder / EXECUTED), last=True)
        with (
            self
        ):  # nothing writes into the folder after an interrupt, or a refusal meanwhile
            meanwhile()
            said = self.complaints()
            self.process.wait()
        if said:
            raise ProjectError("\n".join([*said, f"The complete log is in {self.log}"]))

    def order(
        self,
        folder: Path,
        variables: Mapping[str, str],
        again: Iterable[str] = (),
        last: bool = False,
    ) -> None:
        """Begin to render what changed.

        Args:
            folder: of Sphinx's output.
            variables: for its environment.
            again: pages that are read again, whatever the times of their files are.
            last: whether the process ends after it.
        """
        assert self.process.stdin is not None
        self.log.parent.mkdir(parents=True, exist_ok=True)
        self.log.write_text("Sphinx ended before it began.\n", "utf8")
        order = [str(folder), dict(variables), [*again], last]
        with suppress(BrokenPipeError):  # reported below
            print(json.dumps(order), file=self.process.stdin, flush=True)

    def complaints(self) -> list[str]:
        """Wait for the end of the render; return its warnings and errors."""
        assert self.process.stdout is not None
        if not (line := self.process.stdout.readline()):
            return [
                f"Sphinx stopped with {ended(self.process.wait())}. Log: {self.log}"
            ]
        said, ends = json.loads(line)
        if ends:
            self.process.wait()
        return said


def read_again(folder: Path, pages: Iterable[str]) -> None:
    """Make Sphinx read some pages again, whatever the times of their files are."""
    for name in pages:
        (folder / DOCTREES / f"{name}.doctree").unlink(missing_ok=True)


def load(book: Path, folder: Path, warnings: io.StringIO) -> Any:
    """Return Sphinx with the book's configuration, as Jupyter Book loads it."""
    from jupyter_book.config import get_final_config
    from sphinx.application import Sphinx

    toc = str(book / "_toc.yml")
    given = {"external_toc_path": toc, "nitpicky": True, "latex_individualpages": False}
    config, _ = get_final_config(
        user_yaml=book / "_config.yml",
        cli_config=given,
        sourcedir=book,
        use_external_toc=True,
    )
    return Sphinx(
        book,
        None,
        folder / HTML,
        folder / DOCTREES,
        "html",
        config,
        status=sys.stdout,
        warning=warnings,
        keep_going=True,
    )


def main() -> None:
    """Load Jupyter Book and the book's extensions, then render once for each order."""
    collect_rarely()
    book, log = map(Path, sys.argv[1:])
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    import yaml

    with suppress(Exception):  # reported by the render
        config = yaml.safe_load((book / "_config.yml").read_text("utf8"))
        extensions = config["sphinx"]["config"]["extensions"]
        for name in ("jupyter_book.config", "sphinx.application", *extensions):
            importlib.import_module(name)
    warnings, again, app = io.StringIO(), set[str](), None
    for line in sys.stdin:
        place, variables, pages, last = json.loads(line)
        folder = Path(place)
        again |= set(pages)
        os.environ.update(variables)
        with open(log, "w") as stream:
            for output in (1, 2):
                os.dup2(stream.fileno(), output)
        warnings.seek(0)
        warnings.truncate()
        failed = []
        try:
            app = app or load(book, folder, warnings)
            read_again(folder, again)
            vars(app.env)["_pickled_doctree_cache"].clear()
            vars(app.env).pop("master_doctree", None)
            app.build()
        except (
            Exception
        ) as error:  # an extension, or the author's page, may raise anything
            traceback.print_exc()
            failed = [f"{type(error).__name__}: {error}"]
        said = [
            line
            for line in ANSI.sub("", warnings.getvalue()).splitlines()
            if line.strip()
        ]
        print(warnings.getvalue(), end="", flush=True)
        if said and app:  # what was not written correctly is written again
            vars(app.env).pop("robo_genesis_shown", None)
        again = again if said else set()
        answer = [[*dict.fromkeys(said), *failed], bool(failed) or last]
        print(json.dumps(answer), file=answers, flush=True)
        if failed or last:
            break
    for (
        child
    ) in multiprocessing.active_children():  # the sitemap's, which ends at a usual exit
        child.kill()
    os._exit(0)  # freeing all doctrees takes half a second


if __name__ == "__main__":
    main()
