"""`make live`: shows a book while it is written, and publishes nothing.

A process with Sphinx loaded renders each changed page; see `sphinx_process`. The
browser gets the last state without warnings and errors, and reloads when there is a new
one.
"""

import asyncio
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from tornado.web import RequestHandler

from robo_genesis.core import project
from robo_genesis.core.files import NO_SOURCE, files_below, locked
from robo_genesis.pipeline.command import TIMEOUT, end_with_parent, say
from robo_genesis.pipeline.html import kept
from robo_genesis.pipeline.html.draft import Draft
from robo_genesis.pipeline.html.serve import SiteFile, listen
from robo_genesis.pipeline.html.sphinx_process import EXECUTED, HTML, SphinxProcess
from robo_genesis.pipeline.pages.book import Page, code_digest, find_pages, page_files
from robo_genesis.pipeline.pages.page_folder import PageRefused, read_record
from robo_genesis.pipeline.pages.page_index import LAST_OUTPUTS, PageIndex
from robo_genesis.pipeline.pages.store import folders, places

# Below the cache folder: what is rendered and shown, separate from the results of `make
# book`.
FOLDER = "live"
SHOWN_LINES = 2  # Lines of warnings and errors of Sphinx that the terminal shows

INTERVAL = 0.1  # Seconds between two looks at the files; a look takes milliseconds

# A page asks for the name of the shown state, and reloads when it is another.
RELOAD = Path(__file__).with_name("live_reload.html").read_bytes()

Seen = dict[Path, tuple[int, int]]


class LiveEndedError(project.ProjectError):
    """`stop` was called."""


class Live:
    """A book that is rendered again after each change.

    One thread calls the methods; another may call `stop`. `execute` runs the pages that
    changed, with `timeout` seconds for a cell; otherwise they are shown with the
    outputs of their last run.
    """

    def __init__(
        self, book: Path, cache: Path, execute: bool = False, timeout: int = TIMEOUT
    ) -> None:
        self.book, self.cache, self.execute, self.timeout = (
            book,
            cache,
            execute,
            timeout,
        )
        self.folder = cache / FOLDER
        self.work, self.site = self.folder / "work", self.folder / "site" / "html"
        self.sphinx: SphinxProcess | None = None
        self.draft: Draft | None = None
        self.started: list[subprocess.Popen[str]] = []
        self.is_ended = False
        self.runs = PageIndex()
        self.reported: set[Path | str] = set()
        self.seen = self.look()

    def look(self) -> Seen:
        """Return time and size of each watched file: of the book, and of the package's code."""
        found: Seen = {}
        for top in (self.book, project.ROOT / "robo_genesis"):
            for path in files_below(top, (project.PUBLISHED,), NO_SOURCE):
                with suppress(OSError):  # an editor replaces files
                    stat = path.stat()
                    found[path] = (stat.st_mtime_ns, stat.st_size)
        return found

    def changed(self) -> set[Path]:
        """Return the files that changed, came or went since the last call."""
        before, self.seen = self.seen, self.look()
        return {path for path, _ in before.items() ^ self.seen.items()}

    def update(self, paths: set[Path]) -> bool:
        """Render after some files changed; return whether there is a new state to show."""
        try:
            built = self.built(find_pages(self.book))
            names = [
                name for name, path in page_files(self.book).items() if path in paths
            ]
            ended = self.sphinx is None or self.sphinx.process.poll() is not None
            if ended or len(names) < len(paths) or built != self.runs:
                self.restart(built)
            assert self.sphinx is not None
            variables = built.write(self.work / EXECUTED) | {LAST_OUTPUTS: "1"}
            self.sphinx.order(self.work, variables, names)
            complaints = self.sphinx.complaints()
            if not complaints:
                self.show()
                return True
        except (project.ProjectError, OSError, ValueError) as error:
            complaints = str(error).splitlines()
        if not self.is_ended:
            more = len(complaints) - SHOWN_LINES
            say(
                "\n".join(complaints[:SHOWN_LINES])
                + (f"  (+{more} lines)" * (more > 0))
            )
            say("The browser keeps the last good state.")
        return False

    def built(self, pages: Sequence[Page]) -> PageIndex:
        """Return the last run of each page; execute the pages that changed, or name them."""
        found, into = PageIndex(), places(pages, self.cache / project.STORE)
        for page in pages:
            place = into[page.docname]  # another after any change that may help
            told = (
                place if self.execute else page.docname
            )  # a failed run, or a run that is needed
            if place.is_dir():
                self.reported -= {place, page.docname}
            elif told not in self.reported:
                self.reported.add(told)
                if self.execute:
                    self.run_page(page)
                else:
                    say(
                        f"{page.docname}: its code, or code that it imports, changed after its "
                        "last run, whose outputs are shown. make live EXECUTE=1 runs it."
                    )
            if folder := self.last_run(page, place):
                found.add(page, folder)
        return found

    def last_run(self, page: Page, place: Path) -> Path | None:
        """Return the folder of the run whose outputs are shown, None if there is none.

        Args:
            page: the page now.
            place: where the store has it if nothing changed. Without that folder, the
                newest run of the same code cells is shown, and without such a run, the
                newest.
        """
        digest = code_digest(page)

        def differs(folder: Path) -> tuple[bool, bool]:
            with suppress(PageRefused):
                return folder != place, read_record(folder).code != digest
            return True, True

        return min(folders(self.cache / project.STORE, page), key=differs, default=None)

    def run_page(self, page: Page) -> None:
        """Execute a page as `make execute` does, and report a failure."""
        say(f"{page.docname}: runs ...")
        command = [sys.executable, str(project.ROOT / "build_scripts" / "execute.py")]
        command += [
            f"--book={self.book}",
            f"--cache={self.cache}",
            f"--timeout={self.timeout}",
        ]
        running = subprocess.Popen(
            command,
            env=os.environ
            | {"PAGE": page.docname, "TO": str(self.folder / "executed")},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=end_with_parent(signal.SIGTERM),
        )
        self.note(running)
        _, report = running.communicate()
        if running.returncode and not self.is_ended:
            say(report.partition("\n\nFAILED: ")[0].strip())
            say(
                f"{page.docname}: the outputs of its last run are shown. It runs again when its "
                "code changes, or code that it imports."
            )

    def note(self, process: subprocess.Popen[str]) -> None:
        """Note a started process, which `stop` ends.

        Raises:
            LiveEndedError: `stop` was called meanwhile; the process was ended.
        """
        self.started = [other for other in self.started if other.poll() is None] + [
            process
        ]
        if (
            self.is_ended
        ):  # set before `stop` reads the list, so one of the two finds the process
            end(process)
            raise LiveEndedError

    def restart(self, built: PageIndex) -> None:
        """Start Sphinx; what it kept is used if only pages changed since the last good state."""
        if self.sphinx is not None:
            end(self.sphinx.process)
        kept.prepare(self.work, kept.read_state(self.book, built))
        self.runs, self.sphinx = (
            built,
            SphinxProcess(self.book, self.folder / "sphinx.log"),
        )
        self.note(self.sphinx.process)

    def show(self) -> None:
        """Copy what changed to the folder that is served."""
        if self.draft is None:
            shutil.rmtree(self.site.parent, ignore_errors=True)  # of an earlier process
            self.draft = Draft(self.work / HTML, self.site.parent)
        self.draft.complete()

    def remember(self) -> None:
        """Mark the last state as good, so that a restart of Sphinx need not read all pages.

        Nothing is marked if a file cannot be read, for example while an editor replaces
        it.
        """
        with suppress(project.ProjectError, OSError, ValueError):
            state = kept.read_state(self.book, self.runs)
            if self.look() == self.seen:
                kept.keep(self.work, state, state)

    def stop(self) -> None:
        """End the processes that this one started; later ones are ended when they start."""
        self.is_ended = True
        for process in self.started:
            end(process)


def end(process: subprocess.Popen[str]) -> None:
    """End a process, and the group that it leads if it has one, by SIGTERM; wait for it."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGTERM)
    process.terminate()
    process.wait()


class State(RequestHandler):
    """Answers with the name of the shown state: the time when it was rendered."""

    shown = time.time_ns()

    def get(self) -> None:
        """Send the name."""
        self.write(str(State.shown))


class LiveFile(SiteFile):
    """Sends files of the shown site; a page gets the script that reloads it."""

    @classmethod
    def get_content(  # type: ignore[override] # tornado accepts bytes
        cls, abspath: str, start: int | None = None, end: int | None = None
    ) -> bytes:
        """Return a file's content from `start` up to `end`."""
        content = Path(abspath).read_bytes()
        if abspath.endswith(".html"):
            content = content.replace(b"</body>", RELOAD)
        return content[start:end]

    def get_content_size(self) -> int:
        """Return the size of the content that is sent."""
        assert self.absolute_path is not None
        return len(self.get_content(self.absolute_path))


async def serve(live: Live, port: int) -> None:
    """Serve a book until this task is cancelled, and render it after each change.

    Args:
        live: the book.
        port: of localhost; 0 takes a free one.

    Raises:
        ProjectError: the port cannot be used, or another process shows a book with this
            cache.
    """
    with locked(live.folder / "lock", "Another make live"):
        at = listen(port, live.site, LiveFile, (("/live-reload", State),))
        try:
            await asyncio.to_thread(watch, live, at)
        finally:
            live.stop()


def watch(live: Live, port: int) -> None:
    """Render a book, say where it is served, and render it after each change until it is ended."""
    live.update(set())
    say(f"http://localhost:{port}/ Ctrl-C ends it.")
    while not live.is_ended:
        time.sleep(INTERVAL)
        paths = live.changed()
        if paths and live.update(paths):
            State.shown = time.time_ns()
            live.remember()
            say(f"Shown: {', '.join(sorted(path.name for path in paths))}")
