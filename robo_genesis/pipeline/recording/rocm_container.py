"""`make evidence-rocm`: record labs in a container with AMD's ROCm and Torch.

The host needs Python, but no other package: what this module imports, imports none.
"""

import os
import shutil
import subprocess
from pathlib import Path

from robo_genesis.core.project import ENGINE_PREFIXES, ROOT, ProjectError

IMAGE = "robo-genesis-rocm"
DOCKERFILE = ".rocm/Dockerfile"
PLACE = "/course"  # Where the container sees the checkout

# Compute interface of all AMD GPUs, and the folder with a node for each of them.
DEVICES = (Path("/dev/kfd"), Path("/dev/dri"))

# How the variables begin that the container gets; the image has a ROCm of its own.
PASSED = tuple(name for name in ENGINE_PREFIXES if name != "ROCM_")


def record(lesson: str) -> int:
    """Build the image and record in it; return the status of the command that failed, or 0.

    Args:
        lesson: whose lab is recorded; empty for all.

    Raises:
        ProjectError: docker and podman, or a device is missing. Nothing was started.
    """
    engine = shutil.which("docker") or shutil.which("podman")
    if engine is None:
        raise ProjectError(
            "PATH has neither docker nor podman. Install one of them, or record without a "
            "container: see book/evidence/recording.md."
        )
    if missing := [str(device) for device in DEVICES if not device.exists()]:
        raise ProjectError(
            f"{' and '.join(missing)} missing here. A recording needs an AMD GPU with its kernel "
            "driver. Install amdgpu-dkms, or use another machine."
        )
    build = [engine, "build", "--tag", IMAGE, "--file", DOCKERFILE, "."]
    status = subprocess.run(build, cwd=ROOT, check=False).returncode
    return status or subprocess.run(run_command(engine, lesson), check=False).returncode


def run_command(engine: str, lesson: str) -> list[str]:
    """Return the command that records in the container.

    Docker's options are those of AMD's page on ROCm containers. The process has the ids
    of the user, so that the bundle belongs to the user, and the groups of the devices.
    Podman keeps the user's own groups.
    """
    run = [engine, "run", "--rm", "--security-opt=seccomp=unconfined"]
    run += [f"--device={device}" for device in DEVICES]
    if Path(engine).name == "podman":
        run += ["--group-add=keep-groups", "--userns=keep-id"]
    else:
        nodes = [node for device in DEVICES for node in (device, *device.glob("*"))]
        groups = {node.stat().st_gid for node in nodes if not node.is_dir()}
        run += [f"--group-add={group}" for group in sorted(groups)]
        run += [f"--user={os.getuid()}:{os.getgid()}"]
    run += [f"--volume={ROOT}:{PLACE}", f"--workdir={PLACE}"]
    passed = sorted(name for name in os.environ if name.startswith(PASSED))
    run += [f"--env={name}" for name in ("HOME=/tmp", "USER=course", *passed)]
    run += [IMAGE, "make", "evidence", "BACKEND=amdgpu", "PYTHON=python"]
    return [*run, *([f"LESSON={lesson}"] if lesson else [])]
