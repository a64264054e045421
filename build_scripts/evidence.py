"""Record a lab's evidence on this machine: `make evidence LESSON=l04`.

Environment: LESSON (which lab), BACKEND=amdgpu|cuda|cpu (the backend that must be found; unset, any
accelerator) and TO (folder for the bundle; unset, `book/evidence`). The camera is always used.
Exit status: 0 recorded, 1 failed, 130 interrupted; unless it is 0, the old bundle still stands.
"""

import argparse
import os
import signal
import sys
from pathlib import Path

from robo_genesis.build import BuildError
from robo_genesis.execute import TIMEOUT
from robo_genesis.pages import PageError
from robo_genesis.project import BOOK, CACHE, ProjectError
from robo_genesis.recording import Recording, RecordingError, record


def require_camera() -> None:
    """Exit with 1 where the environment asks for a run without a camera."""
    for name in ("RENDER", "ROBO_GENESIS_RENDER"):
        value = os.environ.get(name) or "1"
        if value != "1":
            sys.exit(
                f"{name}={value!r} is not valid for a recording, which always has camera frames. "
                "Unset it. Choices: 1."
            )


def failed(report: str) -> int:
    """Print why nothing was recorded; return the exit status."""
    print(f"\n{report}\n\nFAILED: nothing was recorded.", file=sys.stderr)
    return 1


def main() -> int:
    """Record and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--book", type=Path, default=BOOK, help="folder of the pages")
    parser.add_argument("--cache", type=Path, default=CACHE, help="folder of the caches")
    parser.add_argument("--timeout", type=int, default=TIMEOUT, help="seconds for one cell")
    args = parser.parse_args()
    require_camera()
    # SIGTERM takes the same way out as Ctrl-C, so that no kernel stays behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
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
    try:
        print("\n".join(record(recording)))
    except (RecordingError, BuildError, PageError, ProjectError) as error:
        return failed(str(error))
    except OSError as error:
        return failed(f"A file cannot be used: {error}. Give it free space or write access.")
    except KeyboardInterrupt:
        print("\nInterrupted: nothing was recorded.", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
