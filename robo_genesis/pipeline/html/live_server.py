"""The server of `make live`: sends the pages to browsers, and makes them reload."""

import asyncio
import time
from pathlib import Path

from tornado.web import RequestHandler

from robo_genesis.core.files import locked
from robo_genesis.pipeline.html.live import Live
from robo_genesis.pipeline.html.serve import SiteFile, listen

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
        ProjectError: the port cannot be used, or another process shows a book with this cache.
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
    live.say(f"http://localhost:{port}/ Ctrl-C ends it.")
    while not live.is_ended:
        time.sleep(INTERVAL)
        paths = live.changed()
        if paths and live.update(paths):
            State.shown = time.time_ns()
            live.remember()
            live.say(f"Shown: {', '.join(sorted(path.name for path in paths))}")
