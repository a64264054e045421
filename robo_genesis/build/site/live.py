"""`make live`: shows a book while it is written, and publishes nothing.

A process with Sphinx loaded renders each changed page; see `live_sphinx`. The browser gets the last
state without warnings and errors, and reloads when there is a new one.
"""

import asyncio
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.web import Application, RequestHandler, StaticFileHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from robo_genesis.build.built_pages import LAST_OUTPUTS, BuiltPages
from robo_genesis.build.command import say
from robo_genesis.build.kernels import end_with_parent
from robo_genesis.build.page_folder import OUTPUTS, PageRefused, read_record
from robo_genesis.build.page_store import folders
from robo_genesis.build.site import kept
from robo_genesis.core import project
from robo_genesis.lessons.book_pages import Page, code_digest, docnames, find_pages

FOLDER = "live"
"""Below the cache folder: what is rendered and shown, apart from what `make book` makes."""
INTERVAL = 0.1
"""Seconds between two looks at the files; a look takes milliseconds."""
UNWATCHED = ("_build", "__pycache__", ".")
SHOWN_LINES = 2
RELOAD = b"""<script>(() => {
  const wait = () => new WebSocket(`ws://${location.host}/live-reload`);
  const socket = wait();
  socket.onmessage = () => location.reload();
})()</script></body>"""

Seen = dict[Path, tuple[int, int]]


class Reload(WebSocketHandler):
    """A connection by which a page learns that there is a new state."""

    connected: set["Reload"] = set()  # noqa: RUF012 - of all connections

    def open(self, *args: str, **kwargs: str) -> None:
        """Remember the connection."""
        self.connected.add(self)

    def on_close(self) -> None:
        """Forget the connection."""
        self.connected.discard(self)

    @classmethod
    def tell(cls) -> None:
        """Make all pages reload."""
        for one in list(cls.connected):
            with suppress(WebSocketClosedError):
                one.write_message("reload")


class LiveFile(StaticFileHandler):
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

    def set_extra_headers(self, path: str) -> None:
        """Forbid caching and guessed types."""
        self.set_header("Cache-Control", "no-store")
        self.set_header("X-Content-Type-Options", "nosniff")


class Live:
    """A book that is rendered again after each change.

    `say` prints a line. `execute` runs the pages whose code changed; otherwise they are shown with
    the outputs of their last run.
    """

    def __init__(
        self,
        book: Path,
        cache: Path,
        say: Callable[[str], None] = say,
        execute: bool = False,
    ) -> None:
        self.book, self.cache, self.say, self.execute = book, cache, say, execute
        self.work, self.site = cache / FOLDER / "work", cache / FOLDER / "site"
        self.sphinx: subprocess.Popen[str] | None = None
        self.running: subprocess.Popen[Any] | None = None
        self.named: set[str] = set()
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
            if self.sphinx is None or len(names) < len(paths) or self.runs_changed(built):
                self.restart(built)
            complaints = self.render(names)
        except (project.ProjectError, OSError) as error:
            complaints = str(error).splitlines()
        if complaints:
            more = len(complaints) - SHOWN_LINES
            self.say("\n".join(complaints[:SHOWN_LINES]) + (f"  (+{more} lines)" * (more > 0)))
            self.say("The browser keeps the last good state.")
            return False
        self.show()
        return True

    def built(self, pages: Sequence[Page]) -> BuiltPages:
        """Return the last run of each page; execute the pages whose code changed, or name them."""
        store, found = self.cache / project.STORE, BuiltPages()
        for page in pages:
            if self.is_stale(page) and self.execute:
                self.run_page(page)
            for folder in folders(store, page)[:1]:
                found.folders[page.docname] = folder
                if page.declares_bundle:
                    found.outputs[f"{page.lesson}/{page.page}"] = folder / OUTPUTS
            if not self.is_stale(page):
                self.named.discard(page.docname)
            elif page.docname not in self.named:
                self.named.add(page.docname)
                self.say(
                    f"{page.docname}: its code changed after its last run, whose outputs are shown."
                    " make live EXECUTE=1 runs it."
                )
        return found

    def is_stale(self, page: Page) -> bool:
        """Return whether a page's code cells are not those of its last run."""
        newest = folders(self.cache / project.STORE, page)[:1]
        try:
            return [read_record(folder).code for folder in newest] != [code_digest(page)]
        except PageRefused:
            return True

    def run_page(self, page: Page) -> None:
        """Execute a page as `make execute` does.

        Raises:
            ProjectError: it failed; the message is the end of the command's report.
        """
        self.say(f"{page.docname}: runs ...")
        command = [sys.executable, str(project.ROOT / "build_scripts" / "execute.py")]
        command += ["--book", str(self.book), "--cache", str(self.cache)]
        given = os.environ | {"PAGE": page.docname, "TO": str(self.cache / FOLDER / "executed")}
        self.running = subprocess.Popen(
            command, env=given, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        _, report = self.running.communicate()
        if self.running.returncode:
            raise project.ProjectError(report.strip())

    def runs_changed(self, built: BuiltPages) -> bool:
        """Return whether other runs are shown than those that Sphinx was started with."""
        file = self.work / "executed-pages.json"
        return not file.is_file() or file.read_text("utf8") != built.model_dump_json(indent=1)

    def restart(self, built: BuiltPages) -> None:
        """Start Sphinx; what it kept is used if only pages changed since the last good state."""
        self.stop()
        kept.prepare(self.work, kept.read_state(self.book, built))
        given = os.environ | built.write(self.work / "executed-pages.json")
        command = [sys.executable, "-m", "robo_genesis.build.site.live_sphinx"]
        self.sphinx = subprocess.Popen(
            [*command, str(self.book), str(self.work)],
            env=given | {"PYTHONPATH": str(project.ROOT), LAST_OUTPUTS: "1"},
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
            preexec_fn=end_with_parent(),
        )  # fmt: skip

    def render(self, names: Sequence[str]) -> list[str]:
        """Read some pages again and write what depends on them; return warnings and errors."""
        assert self.sphinx is not None
        assert self.sphinx.stdin is not None
        assert self.sphinx.stdout is not None
        with suppress(BrokenPipeError):
            print(json.dumps(names), file=self.sphinx.stdin, flush=True)
        line = self.sphinx.stdout.readline()
        ended: dict[str, Any] = {"said": ["Sphinx was ended."], "ended": True}
        answer = json.loads(line) if line else ended
        if answer["ended"]:  # the next change starts it again
            self.stop()
        return list(answer["said"])

    def show(self) -> None:
        """Copy what changed to the folder that is served."""
        html = self.work / "_build" / "html"
        new = {path.relative_to(html) for path in html.rglob("*") if path.is_file()}
        old = {p.relative_to(self.site) for p in self.site.rglob("*") if p.is_file()}
        for name in old - new:
            (self.site / name).unlink()
        for name in new:
            source, to = html / name, self.site / name
            stat = source.stat()
            is_same = name in old and (to.stat().st_mtime_ns, to.stat().st_size) == (
                stat.st_mtime_ns,
                stat.st_size,
            )
            if not is_same:
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, to)

    def remember(self) -> None:
        """Mark the last state as good, so that a restart of Sphinx need not read all pages."""
        built = BuiltPages.model_validate_json((self.work / "executed-pages.json").read_bytes())
        state = kept.read_state(self.book, built)
        if self.look() == self.seen:
            kept.keep(self.work, state, state)

    def stop(self) -> None:
        """End the processes that this one started."""
        for process in (self.running, self.sphinx):
            if process is not None:
                process.terminate()
                process.wait()
        self.running = self.sphinx = None


async def serve(live: Live, port: int, opened: Callable[[int], None] = lambda port: None) -> None:
    """Serve a book until this task is cancelled, and render it after each change.

    Args:
        live: the book.
        port: of localhost; 0 takes a free one.
        opened: called with the port when there is something to show.

    Raises:
        ProjectError: the port cannot be used.
    """
    files = (r"/(.*)", LiveFile, {"path": str(live.site), "default_filename": "index.html"})
    handlers: list[tuple[str, type[RequestHandler]] | Any] = [("/live-reload", Reload), files]
    server = HTTPServer(Application(handlers, websocket_ping_interval=20))
    try:
        server.listen(port, "127.0.0.1")
    except OSError as error:
        raise project.ProjectError(f"PORT={port}: {error.strerror}. Choose a free one.") from error
    (socket,) = server._sockets.values()
    thread, loop = ThreadPoolExecutor(1), asyncio.get_running_loop()
    try:
        await loop.run_in_executor(thread, partial(live.update, set()))
        opened(socket.getsockname()[1])
        while True:
            await asyncio.sleep(INTERVAL)
            paths: set[Path] = await loop.run_in_executor(thread, partial(live.changed))
            if not paths:
                continue
            is_new: bool = await loop.run_in_executor(thread, partial(live.update, paths))
            if is_new:
                Reload.tell()
                await loop.run_in_executor(thread, partial(live.remember))
                live.say(f"Shown: {', '.join(sorted(path.name for path in paths))}")
    finally:
        live.stop()
        server.stop()
        thread.shutdown(wait=False, cancel_futures=True)
