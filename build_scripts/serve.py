"""Serve the built site on localhost: `make serve` (PORT, default 8000)."""

import os
import sys
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

from robo_genesis.build.publish import PUBLISHED
from robo_genesis.core.project import BOOK


def main() -> int:
    """Serve until Ctrl-C; return 1 if there is no site, or the port is not valid or not free."""
    html = BOOK / PUBLISHED / "html"
    port = os.environ.get("PORT") or "8000"
    if not (html / "index.html").is_file():
        print(f"No site in {html}. `make book` builds it.", file=sys.stderr)
        return 1
    if not port.isdecimal() or not 0 < int(port) < 65536:
        print(f"PORT={port!r} is not valid. Choices: 1 to 65535.", file=sys.stderr)
        return 1
    handler = partial(SimpleHTTPRequestHandler, directory=str(html))
    try:
        server = ThreadingHTTPServer(("127.0.0.1", int(port)), handler)
    except OSError as error:
        print(f"PORT={port}: {error.strerror}. Choose a free port.", file=sys.stderr)
        return 1
    with server:
        print(f"http://localhost:{port}/ serves {html}; Ctrl-C ends it.", flush=True)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            return 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
