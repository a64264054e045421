"""Serve the built site on localhost: `make serve` (PORT, default 8000; 0: a free one)."""

import sys
from contextlib import suppress
from functools import partial
from http.server import ThreadingHTTPServer

from robo_genesis.core.project import BOOK, PUBLISHED
from robo_genesis.pipeline.command import port
from robo_genesis.pipeline.html.serve import SiteHandler


def main() -> int | str:
    """Serve until Ctrl-C; return a message if there is no site, or the port is in use."""
    html = BOOK / PUBLISHED / "html"
    if not (html / "index.html").is_file():
        return f"No site in {html}. `make book` builds it."
    wanted = port()
    handler = partial(SiteHandler, directory=str(html))
    try:
        server = ThreadingHTTPServer(("127.0.0.1", wanted), handler)
    except OSError as error:
        return f"PORT={wanted}: {error.strerror}. Choose a free port."
    with server, suppress(KeyboardInterrupt):
        print(f"http://localhost:{server.server_port}/ serves {html}; Ctrl-C ends it.", flush=True)
        server.serve_forever()
    return 0


if __name__ == "__main__":
    sys.exit(main())
