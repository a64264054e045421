"""The backends of the engine, and what Quadrants and Torch report on each."""

import platform
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# Actual backend → architectures of Quadrants, device of Torch. ROCm calls its device
# `cuda`.
BACKENDS = {
    "cpu": (("x64", "arm64"), "cpu"),
    "cuda": (("cuda",), "cuda"),
    "amdgpu": (("amdgpu",), "cuda"),
    "metal": (("metal",), "mps"),
}

# Kernel module of each accelerator's driver.
DRIVERS = {"amdgpu": "amdgpu", "cuda": "nvidia"}


def contradictions(backend: Any) -> Iterator[tuple[str, object, object]]:
    """Yield (name, found, expected) of each report that does not fit the actual backend.

    Only the build of Torch distinguishes ROCm from CUDA.

    Args:
        backend: has the fields of `session.Backend`; `actual` is one of `BACKENDS`.
    """
    archs, device = BACKENDS[backend.actual]
    if backend.arch not in archs:
        yield "backend.arch", backend.arch, archs
    if backend.torch_device != device:
        yield "backend.torch_device", backend.torch_device, device
    build = bool(backend.hip_version), bool(backend.cuda_version)
    expected = {"amdgpu": (True, False), "cuda": (False, True)}
    if build != expected.get(backend.actual, build):
        yield "whether Torch has (HIP, CUDA)", build, expected[backend.actual]


def driver_version(backend: str, root: Path = Path("/")) -> str | None:
    """Return the version of an accelerator's kernel driver, None for a backend without one.

    Linux's own modules name no version; then it is that of the kernel.

    Args:
        backend: the actual backend.
        root: the root of the file system.
    """
    if backend not in DRIVERS:
        return None
    path = root / "sys" / "module" / DRIVERS[backend] / "version"
    kernel = f"of the kernel {platform.release()}, without a version"
    return path.read_text().strip() if path.is_file() else kernel
