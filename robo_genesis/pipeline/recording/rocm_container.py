"""`make evidence-rocm`: record labs in a container with AMD's ROCm and Torch.

The host needs Python, but no other package: what this module imports, imports none.
"""

import os
import stat
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core.project import ENGINE_PREFIXES, ProjectError

ENGINES = ("docker", "podman")
IMAGE = "robo-genesis-rocm"
DOCKERFILE = ".rocm/Dockerfile"
PLACE = "/course"  # Where the container sees the checkout

# Compute interface of all AMD GPUs, and the folder with a node for each of them.
DEVICES = (Path("/dev/kfd"), Path("/dev/dri"))

# How the variables begin that the container gets; the image has a ROCm of its own.
PASSED = tuple(
    name for name in ENGINE_PREFIXES if name not in ("ROCM_", "NVIDIA_TF32_")
)

WITHOUT = "book/evidence/recording.md describes the steps without a container."


@dataclass(frozen=True, slots=True)
class Host:
    """The machine that starts the container; `find` returns the path of a program, or None."""

    root: Path
    find: Callable[[str], str | None]
    environment: Mapping[str, str]
    devices: tuple[Path, ...] = DEVICES


def record(host: Host) -> int:
    """Build the image and record in it; return the status of the first command that fails, or 0.

    Args:
        host: see there.

    Raises:
        ProjectError: nothing was started.
    """
    for command in commands(host):
        status = subprocess.run(command, cwd=host.root, check=False).returncode
        if status:
            print(f"FAILED with status {status}: {' '.join(command)}", file=sys.stderr)
            return status
    return 0


def commands(host: Host) -> list[list[str]]:
    """Return the command that builds the image and the one that records a lab in it.

    Docker's options are those of AMD's page on ROCm containers. The process has the ids
    of the user, so that the bundle belongs to the user, and the groups of the devices,
    `video` and `render`. Podman keeps the user's own groups.

    Args:
        host: see there. LESSON of its environment names the lab.

    Raises:
        ProjectError: docker and podman, or a device is missing.
    """
    engine = next(filter(host.find, ENGINES), None)
    if engine is None:
        raise ProjectError(
            f"PATH has neither {' nor '.join(ENGINES)}. Install one of them, or record without it: "
            f"{WITHOUT}"
        )
    for device in host.devices:
        if not device.exists():
            raise ProjectError(
                f"{device} is missing here. A recording needs an AMD GPU with its kernel driver: "
                f"{' and '.join(map(str, host.devices))} must exist. Install amdgpu-dkms, or use "
                "another machine."
            )
    build = [engine, "build", "--tag", IMAGE, "--file", DOCKERFILE, "."]
    run = [engine, "run", "--rm", "--security-opt=seccomp=unconfined"]
    run += [f"--device={device}" for device in host.devices]
    if engine == "podman":
        run += ["--group-add=keep-groups", "--userns=keep-id"]
    else:
        nodes = [
            node for device in host.devices for node in (device, *device.glob("*"))
        ]
        groups = {
            node.stat().st_gid for node in nodes if stat.S_ISCHR(node.stat().st_mode)
        }
        run += [f"--group-add={group}" for group in sorted(groups)]
        run += [f"--user={os.getuid()}:{os.getgid()}"]
    run += [f"--volume={host.root}:{PLACE}", f"--workdir={PLACE}"]
    passed = sorted(
        n for n in host.environment if n.startswith(PASSED) or n == "LESSON"
    )
    run += [f"--env={given}" for given in ("HOME=/tmp", "USER=course", *passed)]
    return [build, [*run, IMAGE, "make", "evidence", "BACKEND=amdgpu", "PYTHON=python"]]
