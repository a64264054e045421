"""The backends of the engine, and what Quadrants and Torch report on each."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

BACKENDS = {
    "cpu": (("x64", "arm64"), "cpu"),
    "cuda": (("cuda",), "cuda"),
    "amdgpu": (("amdgpu",), "cuda"),
    "metal": (("metal",), "mps"),
}
"""Actual backend → architectures of Quadrants, device of Torch. ROCm calls its device `cuda`."""

DRIVERS = {"amdgpu": "amdgpu", "cuda": "nvidia"}
"""Kernel module of each accelerator's driver."""


def contradictions(backend: Any) -> Iterator[tuple[str, object, object]]:
    """Yield (name, found, expected) of each report that does not fit the actual backend.

    Only the build of Torch distinguishes ROCm from CUDA.

    Args:
        backend: has `actual`, one of `BACKENDS`, `arch`, `torch_device`, `hip_version` and
            `cuda_version`.
    """
    archs, device = BACKENDS[backend.actual]
    if backend.arch not in archs:
        yield "backend.arch", backend.arch, archs
    if backend.torch_device != device:
        yield "backend.torch_device", backend.torch_device, device
    builds = (bool(backend.hip_version), bool(backend.cuda_version))
    needed = {"amdgpu": (True, False), "cuda": (False, True)}.get(backend.actual, builds)
    if builds != needed:
        yield f"whether Torch has (HIP, CUDA) for {backend.actual}", builds, needed


def driver_version(backend: str, root: Path = Path("/")) -> str | None:
    """Return the version of the kernel driver of a backend, None if it names none.

    Args:
        backend: the actual backend.
        root: the root of the file system.
    """
    path = root / "sys" / "module" / DRIVERS.get(backend, backend) / "version"
    return path.read_text().strip() if path.is_file() else None
