"""Build the course site: `make book`.

Environment: RENDER=0|1 (default 1: the labs' camera is used), JOBS (pages at once; default one
for each core), RELEASE=0|1 (1: from a clean tree alone, with all required evidence current) and
SITE_URL (the address at which the site will stand).
Backend is always the CPU; results of accelerators are recorded apart.
Exit status: 0 published, 1 failed, 130 interrupted; unless it is 0, the old site still stands.
"""

import argparse
import os
import sys
from pathlib import Path

from robo_genesis.apply import recover_or_exit
from robo_genesis.build import Build, BuildError, run_build
from robo_genesis.command import run
from robo_genesis.execute import TIMEOUT
from robo_genesis.pages import PageError
from robo_genesis.project import BOOK, CACHE, ProjectError
from robo_genesis.render import RenderError


def choice(name: str, default: str, choices: tuple[str, ...]) -> str:
    """Return an environment variable that has few valid values; exit with 1 on another."""
    value = os.environ.get(name) or default
    if value not in choices:
        sys.exit(f"{name}={value!r} is not valid. Choices: {', '.join(choices)}.")
    return value


def jobs() -> int | None:
    """Return JOBS, None where it is not set; exit with 1 unless it is a positive number."""
    value = os.environ.get("JOBS") or None
    if value is not None and not (value.isdecimal() and int(value) > 0):
        sys.exit(f"JOBS={value!r} is not valid. Give the number of pages that run at once, from 1.")
    return int(value) if value else None


def require_cpu() -> None:
    """Exit with 1 where the environment asks for another backend than the CPU."""
    value = os.environ.get("ROBO_GENESIS_BACKEND") or "cpu"
    if value != "cpu":
        sys.exit(
            f"ROBO_GENESIS_BACKEND={value!r} is not valid for a build, which measures on the CPU: "
            "its pages show what was measured there, and accelerators are recorded apart. "
            "Unset it. Choices: cpu."
        )
    os.environ["ROBO_GENESIS_BACKEND"] = "cpu"


def main() -> int:
    """Run the build and return its exit status."""
    recover_or_exit()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--book", type=Path, default=BOOK, help="folder of the pages")
    parser.add_argument("--cache", type=Path, default=CACHE, help="folder of the caches")
    parser.add_argument("--timeout", type=int, default=TIMEOUT, help="seconds for one cell")
    args = parser.parse_args()
    os.environ["ROBO_GENESIS_RENDER"] = choice("RENDER", "1", ("0", "1"))
    require_cpu()
    release = choice("RELEASE", "0", ("0", "1")) == "1"
    if release and os.environ["ROBO_GENESIS_RENDER"] == "0":
        sys.exit("RENDER='0' is not valid with RELEASE=1, which needs camera frames. Unset one.")
    build = Build(
        book=args.book.absolute(),
        cache=args.cache.absolute(),
        jobs=jobs(),
        timeout=args.timeout,
        release=release,
        say=lambda line: print(line, flush=True),
    )
    return run(
        lambda: run_build(build), "published", (BuildError, PageError, ProjectError, RenderError)
    )


if __name__ == "__main__":
    sys.exit(main())
