"""Build the course site: `make book`.

Environment: RENDER=0|1 (default 1: the labs' camera is used), JOBS (pages at once; default one
for each core), RELEASE=0|1 (1: from a clean tree alone, with all required evidence current),
SITE_URL (the address at which the site will stand) and EXECUTED (a folder with all pages as
`make execute` hands them over: then none is executed here).
Backend is always the CPU; results of accelerators are recorded apart.
Where nothing changed since the last build, RELEASE=1 apart, it says so and the site stands.
Exit status: 0 published, 1 failed, 130 interrupted; unless it is 0, the old site still stands.
"""

import argparse
import os
import sys
from pathlib import Path
from typing import Any

from robo_genesis.build.command import choice, collect_rarely, require_cpu, run
from robo_genesis.build.publish import PUBLISHED
from robo_genesis.build.up_to_date import nothing_changed
from robo_genesis.core.project import BOOK, CACHE, ROOT


def jobs() -> int | None:
    """Return JOBS, None where it is not set; exit with 1 unless it is a positive number."""
    value = os.environ.get("JOBS") or None
    if value is not None and not (value.isdecimal() and int(value) > 0):
        sys.exit(f"JOBS={value!r} is not valid. Give the number of pages that run at once, from 1.")
    return int(value) if value else None


def main() -> int:
    """Run the build and return its exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--book", type=Path, default=BOOK, help="folder of the pages")
    parser.add_argument("--cache", type=Path, default=CACHE, help="folder of the caches")
    parser.add_argument("--timeout", type=int, help="seconds for one cell")
    args = parser.parse_args()
    os.environ["ROBO_GENESIS_RENDER"] = choice("RENDER", "1", ("0", "1"))
    require_cpu()
    release = choice("RELEASE", "0", ("0", "1")) == "1"
    if release and os.environ["ROBO_GENESIS_RENDER"] == "0":
        sys.exit("RENDER='0' is not valid with RELEASE=1, which needs camera frames. Unset one.")
    executed = os.environ.get("EXECUTED")
    if release and executed:
        sys.exit(
            f"EXECUTED={executed!r} is not valid with RELEASE=1, which executes all pages anew. "
            "Unset one."
        )
    book, pages_at_once = args.book.absolute(), jobs()
    if not (release or executed) and (lines := nothing_changed(ROOT, book, book / PUBLISHED)):
        print("\n".join(lines))
        return 0
    return build(
        args.cache.absolute(),
        args.timeout,
        book=book,
        jobs=pages_at_once,
        release=release,
        executed=Path(executed).absolute() if executed else None,
    )


def build(cache: Path, timeout: int | None, **settings: Any) -> int:
    """Build the site; what that needs, Sphinx's and Jupyter's packages, is loaded only now."""
    from robo_genesis.build.execute import TIMEOUT
    from robo_genesis.build.page_export import HandoverError
    from robo_genesis.build.render import RenderError
    from robo_genesis.build.stages import Build, BuildError, run_build
    from robo_genesis.core.project import ProjectError
    from robo_genesis.lessons.book_pages import PageError

    collect_rarely()
    asked = Build(
        cache=cache,
        timeout=timeout or TIMEOUT,
        say=lambda line: print(line, flush=True),
        **settings,
    )
    failures = (BuildError, HandoverError, PageError, ProjectError, RenderError)
    return run(lambda: run_build(asked), "published", failures)


if __name__ == "__main__":
    sys.exit(main())
