"""Kernels that no configuration of the user reaches, and that never outlive the build."""

import multiprocessing
import os
import shutil
import signal
import subprocess
import threading
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil  # type: ignore[import-untyped]
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager

from robo_genesis.core.project import ENGINE_PREFIXES

# The variables of the user that a kernel gets: the machine's own, and the engine's
# switches, which are part of the pages' fingerprint. Others (MPLBACKEND, PYTHONSTARTUP
# …) would change pages.
MACHINE = ("HOME", "LANG", "LD_LIBRARY_PATH", "LOGNAME", "PATH", "TMPDIR", "TZ", "USER")
ALLOWED = ("LC_", "NVIDIA_", "SSL_", *ENGINE_PREFIXES)

START = "__import__('robo_genesis.pipeline.pages.opened', fromlist=['start']).start()"
ARGUMENTS = [f"--IPKernelApp.exec_lines={START}"]


class CleanKernelManager(AsyncKernelManager):
    """Starts the kernel of this interpreter and knows no installed kernelspec.

    `busy` is set while a cell runs, `process` when the kernel starts. They are class
    attributes because nbclient takes a class, not an instance; each worker process has
    one kernel.
    """

    busy = False
    process: subprocess.Popen[bytes] | None = None

    def __init__(self, **given: Any) -> None:
        """Set what differs from a usual kernel.

        The engine saves what it compiled in its exit handler, for which the usual 5 s
        are too short; SIGTERM comes after the first half. The sockets have names,
        because kernels that start at the same time can draw the same TCP port. With
        `@`, a name is one of Linux and not of a file, whose path may have 107
        characters only.
        """
        sockets = {"transport": "ipc", "ip": f"@robo-{uuid.uuid4().hex}"}
        no_specs = KernelSpecManager(
            kernel_dirs=[]
        )  # so that only the native kernel is left
        own = {"shutdown_wait_time": 120.0, "kernel_spec_manager": no_specs}
        super().__init__(**given | sockets | own)

    async def start_kernel(self, **given: Any) -> None:  # type: ignore[override]
        """Start the kernel, and keep its process, whose exit status says why it died."""
        await super().start_kernel(**given)
        type(self).process = self.provisioner.process  # type: ignore[union-attr]

    async def shutdown_kernel(  # type: ignore[override]
        self, now: bool = False, restart: bool = False
    ) -> None:
        """Stop the kernel, at once if a cell still runs: a busy kernel answers no request."""
        await super().shutdown_kernel(now=now or type(self).busy, restart=restart)


def users_variables() -> dict[str, str]:
    """Return the variables of this process that a kernel gets."""
    return {
        n: v for n, v in os.environ.items() if n in MACHINE or n.startswith(ALLOWED)
    }


def clean_environment(
    home: Path, root: Path, extra: Mapping[str, str]
) -> dict[str, str]:
    """Return the whole environment for a kernel.

    Args:
        home: folder for IPython's and Jupyter's own files.
        root: the checkout, the only entry of the kernel's PYTHONPATH.
        extra: variables of this run.
    """
    folders = {
        "IPYTHONDIR": home / "ipython",
        **dict.fromkeys(("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR"), home / "jupyter"),
        "JUPYTER_RUNTIME_DIR": home,
    }
    for folder in folders.values():
        folder.mkdir(parents=True, exist_ok=True)
    return {
        **users_variables(),
        **{name: str(path) for name, path in folders.items()},
        "JUPYTER_NO_CONFIG": "1",
        "JUPYTER_PREFER_ENV_PATH": "1",
        "LC_ALL": "C.UTF-8",
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
        "PYTHONHASHSEED": "0",
        "PYTHONNOUSERSITE": "1",
        "PYTHONPATH": str(root),
        # with 1, each call of a compiled kernel prints an empty text
        "QD_ENABLE_PYBUF": "0",
        "TZ": "UTC",
        **extra,
    }


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Start processes that a Ctrl-C of the terminal does not reach.

    The mask is inherited: the parent alone answers the interrupt, and kills them.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def wait_or_kill(
    process: subprocess.Popen[bytes], meanwhile: Callable[[], object] = lambda: None
) -> int:
    """Wait for a process and return its exit status; an exception kills it and all below it.

    Args:
        process: see above.
        meanwhile: called each second.
    """
    try:
        while True:
            with suppress(subprocess.TimeoutExpired):
                return process.wait(timeout=1)
            meanwhile()
    finally:
        if process.poll() is None:
            kill_with_descendants([process.pid])


def kill_with_descendants(pids: Iterable[int]) -> None:
    """Kill processes and everything below them.

    Kernels lead sessions of their own, so no process group contains them all. The
    processes are stopped first: a stopped worker cannot start one more kernel while the
    list is made.

    Args:
        pids: process ids; processes that are gone are skipped.
    """
    doomed: list[Any] = []
    for pid in pids:
        with suppress(psutil.NoSuchProcess):
            process = psutil.Process(pid)
            process.suspend()
            doomed += [process, *process.children(recursive=True)]
    for process in doomed:
        with suppress(psutil.NoSuchProcess):
            process.kill()
    psutil.wait_procs(doomed, timeout=10)


def die_with_parent(scratch: Path) -> None:
    """Make this worker kill its kernel and itself when the build process is gone.

    Args:
        scratch: temporary folder of the build, which no other process would remove.
    """
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def wait_and_die() -> None:
        parent.join()
        children = psutil.Process().children(recursive=True)
        kill_with_descendants(child.pid for child in children)
        shutil.rmtree(scratch, ignore_errors=True)
        os._exit(1)

    threading.Thread(target=wait_and_die, daemon=True).start()
