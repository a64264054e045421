"""Kernels that no configuration of the user reaches, and that never outlive the build."""

import os
import subprocess
import uuid
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import psutil  # type: ignore[import-untyped]
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager

from robo_genesis.core.project import ENGINE_PREFIXES, ROOT

# The variables of the user that a kernel gets: the machine's own, and the engine's
# switches, which are part of the pages' fingerprint. Others (MPLBACKEND, PYTHONSTARTUP
# …) would change pages.
MACHINE = ("HOME", "LANG", "LD_LIBRARY_PATH", "LOGNAME", "PATH", "TMPDIR", "TZ", "USER")
ALLOWED = ("LC_", "NVIDIA_", "SSL_", *ENGINE_PREFIXES)

# A kernel executes this file first, in a namespace of its own.
START = f"exec(open({str(Path(__file__).with_name('kernel_start.py'))!r}).read(), {{}})"
ARGUMENTS = [f"--IPKernelApp.exec_lines={START}"]


class CleanKernelManager(AsyncKernelManager):
    """Starts the kernel of this interpreter and knows no installed kernelspec.

    `busy` is set while a cell runs, `process` when the kernel starts.
    """

    busy = False
    process: subprocess.Popen[bytes] | None = None

    def __init__(self, folder: Path) -> None:
        """Set what differs from a usual kernel.

        The engine saves what it compiled in its exit handler, for which the usual 5 s
        are too short; SIGTERM comes after the first half. The sockets have names,
        because kernels that start at the same time can draw the same TCP port. With
        `@`, a name is one of Linux and not of a file, whose path may have 107
        characters only.

        Args:
            folder: gets the file that describes the connection.
        """
        super().__init__(
            connection_file=str(folder / "kernel.json"),
            transport="ipc",
            ip=f"@robo-{uuid.uuid4().hex}",
            shutdown_wait_time=120.0,
            kernel_spec_manager=KernelSpecManager(kernel_dirs=[]),
        )

    async def start_kernel(self, **given: object) -> None:  # type: ignore[override]
        """Start the kernel, and keep its process, whose exit status says why it died."""
        await super().start_kernel(**given)
        self.process = self.provisioner.process  # type: ignore[union-attr]

    async def shutdown_kernel(  # type: ignore[override]
        self, now: bool = False, restart: bool = False
    ) -> None:
        """Stop the kernel, at once if a cell still runs: a busy kernel answers no request."""
        if self.busy:
            self.kill()
        await super().shutdown_kernel(now=now or self.busy, restart=restart)

    def kill(self) -> None:
        """Kill the kernel, if it was started, and all processes below it."""
        if self.process:
            kill_with_descendants(self.process.pid)


def users_variables() -> dict[str, str]:
    """Return the variables of this process that a kernel gets."""
    return {
        n: v for n, v in os.environ.items() if n in MACHINE or n.startswith(ALLOWED)
    }


def clean_environment(home: Path, extra: Mapping[str, str]) -> dict[str, str]:
    """Return the whole environment for a kernel.

    Args:
        home: folder for IPython's and Jupyter's own files.
        extra: variables of this run.
    """
    return {
        **users_variables(),
        "IPYTHONDIR": str(home),
        "JUPYTER_CONFIG_DIR": str(home),
        "JUPYTER_DATA_DIR": str(home),
        "JUPYTER_RUNTIME_DIR": str(home),
        "JUPYTER_NO_CONFIG": "1",
        "JUPYTER_PREFER_ENV_PATH": "1",
        "LC_ALL": "C.UTF-8",
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
        "PYTHONHASHSEED": "0",
        "PYTHONNOUSERSITE": "1",
        "PYTHONPATH": str(ROOT),
        # with 1, each call of a compiled kernel prints an empty text
        "QD_ENABLE_PYBUF": "0",
        "TZ": "UTC",
        **extra,
    }


def kill_with_descendants(pid: int) -> None:
    """Kill a process and everything below it; processes that are gone are skipped.

    Kernels lead sessions of their own, so no process group contains them all. The
    process is stopped first, so that it starts no other while the list is made.
    """
    doomed: list[psutil.Process] = []
    with suppress(psutil.NoSuchProcess):
        process = psutil.Process(pid)
        process.suspend()
        doomed = [process, *process.children(recursive=True)]
    for process in doomed:
        with suppress(psutil.NoSuchProcess):
            process.kill()
    psutil.wait_procs(doomed, timeout=10)
