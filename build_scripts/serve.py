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


if __name__ == "__main__":
    html = BOOK / PUBLISHED / "html"
    if not (html / "index.html").is_file():
        sys.exit(f"No site in {html}. `make book` builds it.")
    try:
        with suppress(KeyboardInterrupt):
            asyncio.run(serve(html, port()))
    except ProjectError as error:
        sys.exit(str(error))
