"""Serve the built site on localhost: `make serve` (PORT, default 8000; 0: a free one)."""

import asyncio
import sys
from contextlib import suppress
from pathlib import Path

from robo_genesis.core.project import BOOK, PUBLISHED, ProjectError
from robo_genesis.pipeline.command import port, say
from robo_genesis.pipeline.html.serve import listen


async def serve(html: Path, wanted: int) -> None:
    """Serve until Ctrl-C."""
    say(f"http://localhost:{listen(wanted, html)}/ serves {html}; Ctrl-C ends it.")
    await asyncio.Event().wait()


def main() -> int | str:
    """Serve until Ctrl-C; return a message if there is no site, or the port is in use."""
    html = BOOK / PUBLISHED / "html"
    if not (html / "index.html").is_file():
        return f"No site in {html}. `make book` builds it."
    try:
        with suppress(KeyboardInterrupt):
            asyncio.run(serve(html, port()))
    except ProjectError as error:
        return str(error)
    return 0


if __name__ == "__main__":
    sys.exit(main())
