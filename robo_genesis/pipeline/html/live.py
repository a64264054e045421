"""`make live`: shows a book while it is written, and publishes nothing.

A process with Sphinx loaded renders each changed page; see `sphinx_process`. The browser gets the
last state without warnings and errors, and reloads when there is a new one; see `live_server`.
"""

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.pipeline.command import TIMEOUT, end_with_parent, say
from robo_genesis.pipeline.html import kept
from robo_genesis.pipeline.html.sphinx_process import EXECUTED, HTML, SphinxProcess
from robo_genesis.pipeline.pages.book import Page, code_digest, docnames, find_pages
from robo_genesis.pipeline.pages.built import LAST_OUTPUTS, BuiltPages
from robo_genesis.pipeline.pages.folder import PageRefused, read_record
from robo_genesis.pipeline.pages.store import folders, places

FOLDER = "live"
"""Below the cache folder: what is rendered and shown, apart from what `make book` makes."""
UNWATCHED = ("_build", "__pycache__", ".")
SHOWN_LINES = 2
"""Lines of warnings and errors of Sphinx that the terminal shows."""

Seen = dict[Path, tuple[int, int]]


class LiveEndedError(project.ProjectError):
    """`stop` was called."""


class Live:
    """A book that is rendered again after each change.

    One thread calls the methods; another may call `stop`. `say` prints a line. `execute` runs the
    pages that changed, with `timeout` seconds for a cell; otherwise they are shown with the outputs
    of their last run.
    """

    def __init__(
        self,
        book: Path,
        cache: Path,
        say: Callable[[str], None] = say,
        execute: bool = False,
        timeout: int = TIMEOUT,
    ) -> None:
        self.book, self.cache, self.say = book, cache, say
        self.execute, self.timeout = execute, timeout
        self.folder = cache / FOLDER
        self.work, self.site, self.log = (
            self.folder / name for name in ("work", "site", "sphinx.log")
        )
        self.sphinx: SphinxProcess | None = None
        self.started: list[subprocess.Popen[str]] = []
        self.is_ended = False
        self.named: set[str] = set()
        self.failed: set[Path] = set()
        self.seen = self.look()

    def look(self) -> Seen:
        """Return time and size of each watched file: of the book, and of the package's code."""
        found: Seen = {}
        for top in (self.book, project.ROOT / "robo_genesis"):
            for here, inside, files in os.walk(top):
                inside[:] = [name for name in inside if not name.startswith(UNWATCHED)]
                shown = (name for name in files if name[0] not in ".#" and name[-1] != "~")
                for path in (Path(here, name) for name in shown):
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
            pages = find_pages(self.book)
            built = self.built(pages)
            known = {name.removesuffix(".md") for name in docnames(self.book / "_toc.yml")}
            names = [name for name in known if self.book / f"{name}.md" in paths]
            runs = self.sphinx is not None and self.sphinx.process.poll() is None
            if not runs or len(names) < len(paths) or self.runs_changed(built):
                self.sphinx = self.restart(built)
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
            self.say("\n".join(complaints[:SHOWN_LINES]) + (f"  (+{more} lines)" * (more > 0)))
            self.say("The browser keeps the last good state.")
        return False

    def built(self, pages: Sequence[Page]) -> BuiltPages:
        """Return the last run of each page; execute the pages that changed, or name them."""
        found, into = BuiltPages(), places(pages, self.cache / project.STORE)
        for page in pages:
            place = into[page.docname]
            if self.execute and not place.is_dir() and place not in self.failed:
                self.run_page(page, place)
            if folder := self.last_run(page, place):
                found.add(page, folder)
            if place.is_dir():
                self.named.discard(page.docname)
            elif page.docname not in self.named and not self.execute:
                self.named.add(page.docname)
                self.say(
                    f"{page.docname}: its code, or code that it imports, changed after its last "
                    "run, whose outputs are shown. make live EXECUTE=1 runs it."
                )
        return found

    def last_run(self, page: Page, place: Path) -> Path | None:
        """Return the folder of the run whose outputs are shown, None if there is none.

        Args:
            page: the page now.
            place: where the store has it if nothing changed. Without that folder, the newest run of
                the same code cells is shown, and without such a run, the newest.
        """
        stored, digest = folders(self.cache / project.STORE, page), code_digest(page)

        def has_its_code(folder: Path) -> bool:
            with suppress(PageRefused):
                return read_record(folder).code == digest
            return False

        if place.is_dir():
            return place
        return next(iter([*filter(has_its_code, stored)] or stored), None)

    def run_page(self, page: Page, place: Path) -> None:
        """Execute a page as `make execute` does; report a failure, and do not try it again.

        Args:
            page: the page.
            place: where the store will have it. It is another after any change that may help.
        """
        self.say(f"{page.docname}: runs ...")
        command = [sys.executable, str(project.ROOT / "build_scripts" / "execute.py")]
        command += ["--book", str(self.book), "--cache", str(self.cache)]
        command += ["--timeout", str(self.timeout)]
        running = subprocess.Popen(
            command,
            env=os.environ | {"PAGE": page.docname, "TO": str(self.folder / "executed")},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=end_with_parent(signal.SIGTERM),
        )
        self.note(running)
        _, report = running.communicate()
        if running.returncode and not self.is_ended:
            self.failed.add(place)
            self.say(report.partition("\n\nFAILED: ")[0].strip())
            self.say(
                f"{page.docname}: the outputs of its last run are shown. It runs again when its "
                "code changes, or code that it imports."
            )

    def note(self, process: subprocess.Popen[str]) -> None:
        """Note a started process, which `stop` ends.

        Raises:
            LiveEndedError: `stop` was called meanwhile; the process was ended.
        """
        self.started = [other for other in self.started if other.poll() is None] + [process]
        if self.is_ended:  # set before `stop` reads the list, so one of the two finds the process
            end(process)
            raise LiveEndedError

    def runs_changed(self, built: BuiltPages) -> bool:
        """Return whether other runs are shown than those that Sphinx was started with."""
        file = self.work / EXECUTED
        return not file.is_file() or file.read_text("utf8") != built.model_dump_json(indent=1)

    def restart(self, built: BuiltPages) -> SphinxProcess:
        """Start Sphinx; what it kept is used if only pages changed since the last good state."""
        if self.sphinx is not None:
            end(self.sphinx.process)
        kept.prepare(self.work, kept.read_state(self.book, built))
        sphinx = SphinxProcess(self.book, self.log)
        self.note(sphinx.process)
        return sphinx

    def show(self) -> None:
        """Copy what changed to the folder that is served."""
        html = self.work / HTML
        new = {path.relative_to(html) for path in html.rglob("*") if path.is_file()}
        old = {p.relative_to(self.site) for p in self.site.rglob("*") if p.is_file()}
        for name in old - new:
            (self.site / name).unlink()
        for name in new:
            source, to = html / name, self.site / name
            # Two edits may give the same size and, where file times are coarse, the same time.
            if name not in old or source.read_bytes() != to.read_bytes():
                to.parent.mkdir(parents=True, exist_ok=True)
                beside = to.with_name(f".{to.name}.next")
                shutil.copy2(source, beside)
                os.replace(beside, to)  # a browser gets the old file or the new one

    def remember(self) -> None:
        """Mark the last state as good, so that a restart of Sphinx need not read all pages.

        Nothing is marked if a file cannot be read, for example while an editor replaces it.
        """
        with suppress(project.ProjectError, OSError, ValueError):
            built = BuiltPages.model_validate_json((self.work / EXECUTED).read_bytes())
            state = kept.read_state(self.book, built)
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
