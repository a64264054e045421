"""The server of `make serve` and `make live`: sends a site's files as static hosts do."""

from pathlib import Path
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, StaticFileHandler

from robo_genesis.core.project import ProjectError


class SiteFile(StaticFileHandler):
    """Sends files of a site, and no list of a folder or file to which a link leads out of it.

    Browsers take each file for the type that it is sent with, and ask for it again each
    time.
    """

    def set_default_headers(self) -> None:
        """Forbid caching and guessed types."""
        self.set_header("Cache-Control", "no-store")
        self.set_header("X-Content-Type-Options", "nosniff")

    def get_cache_time(self, *file: object) -> int:
        """Return 0: Tornado would let browsers keep a file whose address has a version."""
        return 0


def listen(
    port: int,
    site: Path,
    handler: type[SiteFile] = SiteFile,
    more: tuple[Any, ...] = (),
) -> int:
    """Serve a site as long as the running loop of asyncio; return the port.

    Args:
        port: of localhost; 0 takes a free one.
        site: the folder with the home page.
        handler: of the site's files.
        more: handlers of other addresses.

    Raises:
        ProjectError: the port cannot be used.
    """
    files = (r"/(.*)", handler, {"path": str(site), "default_filename": "index.html"})
    server = HTTPServer(Application([*more, files]))
    try:
        sockets = bind_sockets(port, "127.0.0.1")
    except OSError as error:
        raise ProjectError(
            f"PORT={port}: {error.strerror}. Choose a free port."
        ) from error
    server.add_sockets(sockets)
    return sockets[0].getsockname()[1]
