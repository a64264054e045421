"""Execute one page and hand it over: `make execute PAGE=l04/lab TO=folder`.

`make book EXECUTED=folder` builds the site from such folders, on this machine or another.
Environment: PAGE (a page of the table of contents, or lesson/page), TO (gets the page's folder) and
RENDER=0|1 (default 1: the labs' camera is used). With `--list`, print the pages as JSON instead.
Exit status: 0 handed over, 1 failed, 130 interrupted; unless it is 0, an older folder still stands.
"""

import argparse
import json
import os
import sys
from pathlib import Path

from robo_genesis.build.command import choice, require_cpu, run
from robo_genesis.build.execute import TIMEOUT
from robo_genesis.build.execute_one import execute_one
from robo_genesis.build.page_export import HandoverError
from robo_genesis.build.stages import Build, BuildError
from robo_genesis.core.project import BOOK, CACHE, ProjectError
from robo_genesis.lessons.book_pages import PageError, find_pages


def main() -> int:
    """Execute or list, and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", action="store_true", help="print the pages and execute none")
    parser.add_argument("--book", type=Path, default=BOOK, help="folder of the pages")
    parser.add_argument("--cache", type=Path, default=CACHE, help="folder of the caches")
    parser.add_argument("--timeout", type=int, default=TIMEOUT, help="seconds for one cell")
    args = parser.parse_args()
    failures = (BuildError, HandoverError, PageError, ProjectError)
    if args.list:
        return run(
            lambda: [json.dumps([p.docname for p in find_pages(args.book)])], "listed", failures
        )
    os.environ["ROBO_GENESIS_RENDER"] = choice("RENDER", "1", ("0", "1"))
    require_cpu()
    page, to = os.environ.get("PAGE") or "", os.environ.get("TO")
    build = Build(
        book=args.book.absolute(),
        cache=args.cache.absolute(),
        timeout=args.timeout,
        command="make execute",
        say=lambda line: print(line, flush=True),
    )
    folder = Path(to).absolute() if to else None
    return run(lambda: execute_one(page, folder, build), "handed over", failures)


if __name__ == "__main__":
    sys.exit(main())
