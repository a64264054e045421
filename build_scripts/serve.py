"""Serve the built site on localhost: `make serve` (PORT, default 8000; 0: a free one)."""

import asyncio
import sys
from pathlib import Path

from robo_genesis.core.project import BOOK, PUBLISHED
from robo_genesis.pipeline.command import port, run, say
from robo_genesis.pipeline.html.serve import listen


async def serve(html: Path, wanted: int) -> int:
    """Serve until Ctrl-C."""
    say(f"http://localhost:{listen(wanted, html)}/ serves {html}; Ctrl-C ends it.")
    await asyncio.Event().wait()
    return 0


if __name__ == "__main__":
    html = BOOK / PUBLISHED / "html"
    if not (html / "index.html").is_file():
        sys.exit(f"No site in {html}. `make book` builds it.")
    sys.exit(run(lambda: asyncio.run(serve(html, port())), "changed"))
