"""Execute one page and export it as files: `make execute PAGE=l04/lab TO=folder`.

`make book EXECUTED=folder` builds the site from such folders, on this machine or
another.
Environment: PAGE (a page of the table of contents, or lesson/page), TO (gets the page's
    folder) and
RENDER=0|1 (default 1: the labs' camera is used). With `--list`, print the pages as JSON instead.
Exit status: 0 exported, 1 failed, 130 interrupted; unless it is 0, an older folder is
    unchanged.
"""

import json
import os
import sys

from robo_genesis.pipeline.command import parser, path, run, set_contract
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.stages import Build, export_one


def main() -> int:
    """Execute or list, and return the exit status."""
    arguments = parser(__doc__)
    arguments.add_argument(
        "--list", action="store_true", help="print the pages and execute none"
    )
    args = arguments.parse_args()
    if args.list:
        return run(
            lambda: [json.dumps([p.docname for p in find_pages(args.book)])], "listed"
        )
    set_contract()
    build = Build(
        book=args.book, cache=args.cache, timeout=args.timeout, command="make execute"
    )
    name, to = os.environ.get("PAGE") or "", path("TO")
    return run(lambda: export_one(name, to, build), "exported")


if __name__ == "__main__":
    sys.exit(main())
