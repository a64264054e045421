"""The server of `make live`: sends the pages to browsers, and makes them reload."""

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, RequestHandler, StaticFileHandler

from robo_genesis.core.files import locked
from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.live import Live
from robo_genesis.pipeline.pages.kernels import described

INTERVAL = 0.1
"""Seconds between two looks at the files; a look takes milliseconds."""
RELOAD = b"""<script>(() => {
  let seen;
  setInterval(async () => {
    const state = await (await fetch("/live-reload")).text();
    if (seen !== undefined && seen !== state) location.reload();
    seen = state;
  }, 500);
})()</script></body>"""
"""A page asks for the name of the shown state, and reloads when it is another."""


class State(RequestHandler):
    """Answers with the name of the shown state: the time when it was rendered."""

    shown = time.time_ns()

    def get(self) -> None:
        """Send the name."""
        self.write(str(State.shown))


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


async def serve(live: Live, port: int, opened: Callable[[int], None] = lambda port: None) -> None:
    """Serve a book until this task is cancelled, and render it after each change.

    Args:
        live: the book.
        port: of localhost; 0 takes a free one.
        opened: called with the port when there is something to show.

    Raises:
        ProjectError: the port cannot be used, or another process shows a book with this cache.
    """
    with locked(live.folder / "lock", in_use):
        files = (r"/(.*)", LiveFile, {"path": str(live.site), "default_filename": "index.html"})
        handlers: list[Any] = [("/live-reload", State), files]
        server = HTTPServer(Application(handlers))
        try:
            sockets = bind_sockets(port, "127.0.0.1")
        except OSError as error:
            raise ProjectError(f"PORT={port}: {error.strerror}. Choose a free port.") from error
        server.add_sockets(sockets)
        thread, loop = ThreadPoolExecutor(1), asyncio.get_running_loop()
        try:
            await loop.run_in_executor(thread, partial(live.update, set()))
            opened(sockets[0].getsockname()[1])
            while True:
                await asyncio.sleep(INTERVAL)
                paths: set[Path] = await loop.run_in_executor(thread, live.changed)
                if not paths:
                    continue
                is_new: bool = await loop.run_in_executor(thread, partial(live.update, paths))
                if is_new:
                    State.shown = time.time_ns()
                    await loop.run_in_executor(thread, live.remember)
                    live.say(f"Shown: {', '.join(sorted(path.name for path in paths))}")
        finally:
            live.stop()
            server.stop()
            thread.shutdown(cancel_futures=True)


def in_use(process: str) -> ProjectError:
    """Return the refusal of a second `make live` with the same cache."""
    return ProjectError(
        f"Another make live runs here:\n{described(process)}\n"
        f"Stop it with Ctrl-C in its terminal or `kill {process}`."
    )
