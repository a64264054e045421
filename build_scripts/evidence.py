"""Record a lab's evidence on this machine: `make evidence LESSON=l04`.

Environment: LESSON (which lab), BACKEND=amdgpu|cuda|cpu (the backend that must be found; unset, any
accelerator) and TO (folder for the bundle; unset, `book/evidence`). The camera is always used.
Exit status: 0 recorded, 1 failed, 130 interrupted; unless it is 0, the old bundle still stands.
"""

import argparse
import os
import sys
from pathlib import Path

from robo_genesis.build.command import run
from robo_genesis.build.execute import TIMEOUT
from robo_genesis.build.recording import Recording, RecordingError, record
from robo_genesis.build.stages import BuildError
from robo_genesis.core.project import BOOK, CACHE, ProjectError
from robo_genesis.lessons.book_pages import PageError


def require_camera() -> None:
    """Exit with 1 where the environment asks for a run without a camera."""
    for name in ("RENDER", "ROBO_GENESIS_RENDER"):
        value = os.environ.get(name) or "1"
        if value != "1":
            sys.exit(
                f"{name}={value!r} is not valid for a recording, which always has camera frames. "
                "Unset it. Choices: 1."
            )


def main() -> int:
    """Record and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--book", type=Path, default=BOOK, help="folder of the pages")
    parser.add_argument("--cache", type=Path, default=CACHE, help="folder of the caches")
    parser.add_argument("--timeout", type=int, default=TIMEOUT, help="seconds for one cell")
    args = parser.parse_args()
    require_camera()
    to = os.environ.get("TO")
    recording = Recording(
        lesson=os.environ.get("LESSON") or "",
        expected=os.environ.get("BACKEND") or None,
        to=Path(to).absolute() if to else None,
        book=args.book.absolute(),
        cache=args.cache.absolute(),
        timeout=args.timeout,
        say=lambda line: print(line, flush=True),
    )
    return run(
        lambda: record(recording), "recorded", (RecordingError, BuildError, PageError, ProjectError)
    )


if __name__ == "__main__":
    sys.exit(main())
