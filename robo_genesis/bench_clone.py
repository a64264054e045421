"""The copy of the checkout in which `make bench` measures, and how a command is timed there."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import psutil  # type: ignore[import-untyped]

from robo_genesis import project
from robo_genesis.bench import BenchError, Sample
from robo_genesis.kernels import kill_with_descendants
from robo_genesis.pages import find_pages, fingerprint
from robo_genesis.workcopy import OWN, WISHES, copy_tree

EVERY = 0.5
TAIL = 15


@dataclass(frozen=True, slots=True)
class Clone:
    """A working tree of its own with copies of the caches, and a folder for logs beside it."""

    root: Path
    logs: Path

    @property
    def book(self) -> Path:
        """The folder of the pages."""
        return self.root / "book"

    @property
    def pages(self) -> Path:
        """The cache folder of its executed pages."""
        return pages_folder(self.root)

    def time(self, command: Sequence[str], must_say: str = "", **wishes: str) -> Sample:
        """Run a command there and return what it cost.

        Args:
            command: program and arguments.
            must_say: words that its output must hold, else it did something else.
            wishes: further variables of its environment.

        Raises:
            BenchError: it failed, or did not say the words; the message holds its last lines.
        """
        begin = time.monotonic()
        process, log = self._start(command, wishes)
        try:
            _, status, usage = os.wait4(process.pid, 0)  # Popen.wait(timeout) looks every 50 ms
            seconds = time.monotonic() - begin
            process.returncode = os.waitstatus_to_exitcode(status)
        finally:
            _end(process)
        _require(process, log, must_say)
        return Sample(seconds, usage.ru_utime + usage.ru_stime)

    def peak_memory(self, command: Sequence[str], must_say: str = "", **wishes: str) -> int:
        """Run a command there and return the most memory it held with all its processes [bytes].

        What processes share counts once: it is the sum of their proportional set sizes, looked at
        twice a second. For the arguments and errors see `time`.
        """
        process, log = self._start(command, wishes)
        peak = 0
        try:
            while process.poll() is None:
                peak = max(peak, held(process.pid))
                time.sleep(EVERY)
        finally:
            _end(process)
        _require(process, log, must_say)
        return peak

    def _start(
        self, command: Sequence[str], wishes: dict[str, str]
    ) -> tuple[subprocess.Popen[bytes], Path]:
        kept = {name: value for name, value in os.environ.items() if name not in (*OWN, *WISHES)}
        self.logs.mkdir(parents=True, exist_ok=True)
        log = self.logs / f"{len(list(self.logs.iterdir())):03d}.log"
        with log.open("wb") as output:
            process = subprocess.Popen(
                command,
                cwd=self.root,
                env=kept | {"PYTHONPATH": str(self.root)} | wishes,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        return process, log


def held(pid: int) -> int:
    """Return the memory of a process and everything below it, what they share once [bytes]."""
    total = 0
    try:
        processes = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
    except psutil.NoSuchProcess:
        return 0
    for process in processes:
        try:
            total += process.memory_full_info().pss
        except (psutil.NoSuchProcess, psutil.AccessDenied):
            continue
    return total


def _end(process: "subprocess.Popen[bytes]") -> None:
    if process.returncode is None:
        kill_with_descendants([process.pid])


def _require(process: "subprocess.Popen[bytes]", log: Path, must_say: str) -> None:
    """Raise BenchError unless the command succeeded and did what is measured."""
    said = log.read_text("utf8", errors="replace")
    failed = process.returncode != 0
    if failed or must_say not in said:
        why = f"ended with status {process.returncode}" if failed else f"did not say {must_say!r}"
        end = "\n".join(said.rstrip().splitlines()[-TAIL:])
        raise BenchError(f"A command that is measured {why}: {process.args!r}\n{end}\nLog: {log}")


def pages_folder(root: Path, cache: Path | None = None) -> Path:
    """Return the folder of the executed pages of a checkout, there or not."""
    named = fingerprint(find_pages(root / "book"), root)
    return project.page_cache_folder(named, cache or root / ".cache")


def make_clone(root: Path, cache: Path, folder: Path, say: Callable[[str], None]) -> Clone:
    """Copy a checkout with its caches, and bring the copy to the state of a finished build.

    Args:
        root: the checkout.
        cache: its caches: kernels and executed pages are copied, npm's packages are linked.
        folder: for the copy; what stands there is removed.
        say: told of what takes long.

    Raises:
        BenchError: the build failed.
        ProjectError: the checkout cannot be copied.
    """
    shutil.rmtree(folder, ignore_errors=True)
    copy_tree(root, folder / "work", cache, shared=("npm",))
    clone = Clone(folder / "work", folder / "logs")
    for own in (project.engine_cache_folder(root, cache), pages_folder(root, cache)):
        if own.is_dir():
            shutil.copytree(own, clone.root / ".cache" / own.relative_to(cache))
    say("first build of the copy: a new pin or changed code takes minutes to execute")
    clone.time(make("book"))
    return clone


def make(*words: str) -> list[str]:
    """Return the command that makes targets with this interpreter."""
    return ["make", *words, f"PYTHON={sys.executable}"]
