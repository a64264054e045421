"""Install the course into a folder of its own, step by step.

    PYTHONPATH=robo_genesis-….whl python3 -m robo_genesis.install [ADDRESS]

ADDRESS is an index with builds of Torch for the CPU. Without it, Torch comes from pip's
own index, on Linux with CUDA. The wheel and constraints.txt are in one folder, which
gets the folder `course`. The command needs Python alone, without packages. `make`
installs the lock with this module.
Exit status: 0 installed, 1 failed, 130 interrupted. The same command then begins again.
"""

import sys

if not (3, 11) <= sys.version_info < (3, 14):
    found = "The course needs Python 3.11 to 3.13, found {}.{}.".format(
        *sys.version_info
    )
    sys.exit(f"{found} Start one of these.")

import os
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit

from robo_genesis.core.text import ended

# What a student's installation makes, and the lock beside the wheel.
ENVIRONMENT, CONSTRAINTS = "course", "constraints.txt"

# Files of the environment: this module made it, it is complete, and what pip printed.
MARK, DONE, LOG = ".robo-genesis", ".installed", "install.log"

EVERY = 20.0  # Seconds between two lines of progress
QUIETLY = (
    "--no-compile",
    "--disable-pip-version-check",
    "--progress-bar=off",
    "--retries=3",
)
COMPILE = (
    "-m",
    "compileall",
    "-qq",
    "-j",
    "0",
)  # Fails, because packages have files for no Python
# Settings that make pip install elsewhere, or nothing.
REDIRECTIONS = {
    f"PIP_{name}" for name in ("TARGET", "PREFIX", "ROOT", "PYTHON", "DRY_RUN")
}

TAKEN = re.compile(r"Collecting|Processing|Requirement already satisfied")
PYPI, LOOKING = "https://pypi.org/simple", "Looking in indexes: "
# What pip prints when its attempts are used up: the reason, and the path at the index.
LOST = re.compile(r"Retry\(total=0.* after connection broken by (.*): (/\S*)$")
REASON = re.compile(r"(?:\[Errno -?\d+\] |\[SSL: |Tunnel )[^'\")]+|timed out")
NEEDED = (
    "The course needs about 5 GB, with Torch for CUDA 9 GB, and TMPDIR, or /tmp, 2 GB"
)

say = partial(print, flush=True)


class InstallError(Exception):
    """A step failed; the message says why and what to do."""


@dataclass(frozen=True, slots=True)
class Installation:
    """What to install where.

    `folder` gets the environment. `lock` has a line `name==version` for each package.
    `packages` are pip's arguments for all packages but Torch. `torch_index` is the
    index that is tried first for Torch; empty, it is not.
    """

    folder: Path
    lock: Path
    packages: Sequence[str]
    torch_index: str = ""
    say: Callable[[str], None] = say

    def run(self) -> None:
        """Do all steps.

        Raises:
            InstallError: a step failed; the next run empties the folder and begins
                again.
        """
        steps: dict[str, Callable[[], None]] = {
            "an environment for Python's packages": self.environment,
            "Torch": self.torch,
            "the other packages": partial(self.pip, *self.packages),
            "a check of all versions": partial(self.call, "-m", "pip", "check"),
            "bytecode": partial(
                self.call, *COMPILE, str(self.folder / "lib"), statuses=(0, 1)
            ),
        }
        for number, (what, step) in enumerate(steps.items(), start=1):
            place = f"step {number} of {len(steps)}, {what}"
            self.say(f"install  {place}")
            try:
                step()
            except (InstallError, OSError) as error:
                needed = f". {NEEDED}" * ("No space left" in str(error))
                raise InstallError(f"{place}: {error}{needed}") from error
        (self.folder / DONE).touch()

    def environment(self) -> None:
        """Make an empty environment."""
        if not find_spec("ensurepip"):
            raise InstallError(
                "this Python has no ensurepip. On Debian: apt install python3-venv"
            )
        self.empty()
        self.call("-m", "venv", str(self.folder), python=sys.executable)

    def empty(self) -> None:
        """Make the folder, or empty it if this module made it."""
        folder = self.folder
        if ":" in str(folder.absolute()):
            raise InstallError(
                f"{folder.absolute()} has a colon, which separates paths; rename it"
            )
        ours = any((folder / name).is_file() for name in (MARK, DONE))
        free = not folder.exists() or (folder.is_dir() and not any(folder.iterdir()))
        if folder.is_symlink() or not (ours or free):
            raise InstallError(
                f"{folder} is a link, or was not made by this command, so it is not emptied. Move "
                f"it away, or use it as it is: {folder}/bin/python, with make as PYTHON="
            )
        folder.mkdir(exist_ok=True)
        (folder / MARK).touch()  # first: an interrupted installation is still ours
        for path in folder.iterdir():
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            elif path.name != MARK:
                path.unlink()

    def torch(self) -> None:
        """Install Torch by a command of its own: its index has no other package of the course."""
        version = re.search(r"^torch==\S+$", self.lock.read_text("utf8"), re.MULTILINE)
        wanted = (version[0] if version else "torch", "-c", str(self.lock))
        if self.torch_index:
            try:
                return self.pip(
                    "--extra-index-url", self.torch_index, "--timeout", "15", *wanted
                )
            except InstallError as error:
                if not str(error).startswith(self.torch_index):
                    raise
                self.say(
                    f"install  {error}. pip's own index follows, whose Torch can have CUDA"
                )
        return self.pip(*wanted)

    def pip(self, *arguments: str) -> None:
        """Install packages."""
        self.call("-m", "pip", "install", *QUIETLY, *arguments)

    def call(
        self, *arguments: str, python: str = "", statuses: Sequence[int] = (0,)
    ) -> None:
        """Run Python, by default that of the environment, and report how far pip is.

        Raises:
            InstallError: its exit status is not in `statuses`, or an index cannot be
                reached; then the message begins with its address.
        """
        command = [python or str(self.folder / "bin" / "python"), *arguments]
        given = os.environ.keys() - REDIRECTIONS - {"PYTHONPATH", "PYTHONHOME"}
        variables = {name: os.environ[name] for name in given} | {"PIP_USER": "0"}
        with subprocess.Popen(
            command,
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf8",
            errors="replace",
        ) as process:
            try:
                failure = self.follow(process.stdout or ())
            except BaseException:
                process.kill()
                raise
        if (status := process.returncode) not in statuses:
            raise InstallError(failure if status > 0 and failure else ended(status))

    def follow(self, printed: Iterable[str]) -> str:
        """Write what a process prints into the log; return its first error, or its last line."""
        most = self.lock.read_text("utf8").count("\n")
        indexes, error, line, taken, due = [PYPI], "", "", 0, time.monotonic() + EVERY
        with (self.folder / LOG).open("a", encoding="utf8") as log:
            for line in filter(str.strip, printed):
                log.write(line)
                taken += bool(TAKEN.match(line))
                if line.startswith(LOOKING):
                    indexes = line.removeprefix(LOOKING).strip().split(", ")
                if lost := LOST.search(line):
                    raise InstallError(unreachable(lost[1], lost[2], indexes))
                if line.startswith("ERROR: ") and not error:
                    error = line.removeprefix("ERROR: ")
                if line.startswith("Installing collected packages"):
                    self.say(f"install  {taken} packages are here; pip unpacks them")
                    taken = 0
                elif taken and time.monotonic() > due:
                    self.say(f"install  {taken} of at most {most} packages")
                    due += EVERY
        return (line if error.startswith("Exception:") else error or line).strip()


def unreachable(error: str, path: str, indexes: Sequence[str]) -> str:
    """Return which of pip's indexes cannot be reached, why, and what to do."""
    index = next((one for one in indexes if path.startswith(urlsplit(one).path)), path)
    reason = REASON.search(error)
    why = "the proxy: " * ("ProxyError" in error) + (reason[0] if reason else error)
    return f"{index} cannot be reached ({why}): check the network, HTTPS_PROXY and pip's indexes"


def run(installation: Installation) -> int:
    """Install, print the result and return the exit status."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        installation.run()
        return 0
    except (InstallError, KeyboardInterrupt) as error:
        failed, log = isinstance(error, InstallError), installation.folder / LOG
        where = f" pip's log: {log}." if log.is_file() else ""
        again = "Then start the same command again: pip keeps what it downloaded."
        print(
            f"{f'FAILED: {error}' if failed else 'Interrupted'}.{where} {again}",
            file=sys.stderr,
        )
        return 1 if failed else 130


def main() -> int:
    """Install the wheel that has this module, with its constraints, and return the exit status."""
    wheel = Path(__file__).absolute().parents[1]
    lock, index = wheel.with_name(CONSTRAINTS), "".join(sys.argv[1:])
    for path in (wheel, lock):
        if not path.is_file():
            sys.exit(
                f"{path} is not a file; PYTHONPATH names the wheel beside {CONSTRAINTS}"
            )
    if index and not urlsplit(index).scheme:
        sys.exit(
            f"{index!r} is not an address, such as https://download.pytorch.org/whl/cpu"
        )
    packages = ("-c", str(lock), str(wheel), "jupyterlab")
    return run(Installation(wheel.with_name(ENVIRONMENT), lock, packages, index))


if __name__ == "__main__":
    sys.exit(main())
