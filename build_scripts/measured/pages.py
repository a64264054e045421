"""Execute pages of the book in a folder of their own: a command that `make bench` measures.

Usage: pages.py FOLDER [PAGE ...]. Environment: JOBS. No page named: all pages.
"""

import os
import sys
from pathlib import Path

from robo_genesis import project
from robo_genesis.execute import execute_pages
from robo_genesis.page_results import failure_report
from robo_genesis.pages import find_pages


def main(folder: str, *names: str) -> int:
    """Execute and return the exit status."""
    pages = [page for page in find_pages(project.BOOK) if not names or page.docname in names]
    results = execute_pages(
        pages,
        Path(folder),
        jobs=int(os.environ.get("JOBS") or 1),
        environment={
            **project.engine_cache_environment(),
            **project.environment_contract(),
            "ROBO_GENESIS_COMMAND": "make bench",
        },
        on_progress=lambda what, event: print(what, event, flush=True),
    )
    if any(result.failure for result in results):
        print(failure_report(results), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
