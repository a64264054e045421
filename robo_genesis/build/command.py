"""What the commands share: settings from the environment, and how a long one ends."""

import gc
import os
import signal
import sys
from collections.abc import Callable, Sequence

from robo_genesis.core.project import BUILD_BACKEND


def collect_rarely() -> None:
    """Let Python look for cyclic garbage a thousand times less often than it usually does.

    Parsed pages are millions of objects that stay; looking through them again and again takes a
    quarter of a render. What is found rarely costs memory: some 100 MB for ten pages.
    """
    gc.set_threshold(1_000_000, 20, 100)


def run(task: Callable[[], Sequence[str]], done: str, failures: tuple[type[Exception], ...]) -> int:
    """Run a task, print its last lines and return the exit status.

    A cancelled CI job sends SIGTERM: it takes the same way out as Ctrl-C, so that no kernel stays
    behind.

    Args:
        task: does the work and returns the last lines for the user.
        done: what it does to its result: `published`, `recorded`.
        failures: exceptions whose message is a whole report.

    Returns:
        0 done, 1 failed, 130 interrupted.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        print("\n".join(task()))
    except failures as error:
        return _failed(str(error), done)
    except OSError as error:
        report = f"A file cannot be used: {error}. Give it free space or write access."
        return _failed(report, done)
    except KeyboardInterrupt:
        print(f"\nInterrupted: nothing was {done}.", file=sys.stderr)
        return 130
    return 0


def _failed(report: str, done: str) -> int:
    print(f"\n{report}\n\nFAILED: nothing was {done}.", file=sys.stderr)
    return 1


def choice(name: str, default: str, choices: tuple[str, ...]) -> str:
    """Return an environment variable that has few valid values; exit with 1 on another."""
    value = os.environ.get(name) or default
    if value not in choices:
        sys.exit(f"{name}={value!r} is not valid. Choices: {', '.join(choices)}.")
    return value


def require_cpu() -> None:
    """Exit with 1 where the environment asks for another backend than the CPU."""
    value = os.environ.get("ROBO_GENESIS_BACKEND") or BUILD_BACKEND
    if value != BUILD_BACKEND:
        sys.exit(
            f"ROBO_GENESIS_BACKEND={value!r} is not valid for a build, which measures on the CPU: "
            "its pages show what was measured there, and accelerators are recorded apart. "
            f"Unset it. Choices: {BUILD_BACKEND}."
        )
    os.environ["ROBO_GENESIS_BACKEND"] = BUILD_BACKEND


def as_published() -> None:
    """Let what is measured run as the site's pages do: on their backend, with a camera."""
    os.environ["ROBO_GENESIS_RENDER"] = "1"
    os.environ["ROBO_GENESIS_BACKEND"] = BUILD_BACKEND
