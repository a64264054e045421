"""Serve the built site on localhost: `make serve` (PORT, default 8000)."""

import os
import sys
from contextlib import suppress
from functools import partial
from http.server import ThreadingHTTPServer

from robo_genesis.build.site.serve import SiteHandler
from robo_genesis.core.project import BOOK, PUBLISHED


def main() -> int | str:
    """Serve until Ctrl-C; return a message if there is no site, or the port is not valid."""
    html = BOOK / PUBLISHED / "html"
    port = os.environ.get("PORT") or "8000"
    if not (html / "index.html").is_file():
        return f"No site in {html}. `make book` builds it."
    if not port.isdecimal() or not 0 < int(port) < 65536:
        return f"PORT={port!r} is not valid. Choices: 1 to 65535."
    handler = partial(SiteHandler, directory=str(html))
    try:
        server = ThreadingHTTPServer(("127.0.0.1", int(port)), handler)
    except OSError as error:
        return f"PORT={port}: {error.strerror}. Choose a free port."
    with server, suppress(KeyboardInterrupt):
        print(f"http://localhost:{port}/ serves {html}; Ctrl-C ends it.", flush=True)
        server.serve_forever()
    return 0


if __name__ == "__main__":
    sys.exit(main())
