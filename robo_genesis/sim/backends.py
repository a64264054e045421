"""The backends of the engine, and what Quadrants and Torch report on each."""

import platform
import re
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

DRIVERS = {
    "amdgpu": "amdgpu",
    "cuda": "nvidia",
}  # Kernel module of each accelerator's driver

# Tag of a build of Torch, without its version → whether that build has HIP, and CUDA.
BUILDS = {"cpu": (False, False), "rocm": (True, False), "cu": (False, True)}

# The tag in Torch's version: `+cpu`, `+rocm7.2.1`, `+cu130`. PyPI's packages name none,
# and nor do builds from source.
TAG = re.compile(r"\+(cpu|rocm|cu(?=\d))(\d*)\.?(\d*)")

PROCESSOR = (
    r"intel|xeon|epyc|threadripper|opteron|processor|\bcpu\b|apple|pipe\b|swrast"
)

# Words that the name of an accelerator's device never has: of processors and of
# software that draws, and by backend those of other makers.
FOREIGN = {"amdgpu": "nvidia|geforce|tesla|quadro", "cuda": r"\bamd\b|radeon|instinct"}


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
    builds = (bool(backend.hip_version), bool(backend.cuda_version))
    needed = {"amdgpu": (True, False), "cuda": (False, True)}.get(
        backend.actual, builds
    )
    if builds != needed:
        yield f"whether Torch has (HIP, CUDA) for {backend.actual}", builds, needed
    versions, tag = (
        (backend.hip_version, backend.cuda_version),
        TAG.search(backend.torch_version),
    )
    if tag and not (
        builds == BUILDS[tag[1]] and _fits(tag, versions[0] or versions[1] or "")
    ):
        yield (
            f"(HIP, CUDA) of Torch {backend.torch_version}",
            versions,
            f"those of {tag[0]}",
        )


def _fits(tag: re.Match[str], version: str) -> bool:
    """Return whether a version of HIP or CUDA can be that of a build of Torch.

    HIP has the version of its ROCm before ROCm 7, and afterwards that or a lower one.
    """
    found = [int(number) for number in re.findall(r"\d+", version)[:2]]
    named = [int(number) for number in tag.groups()[1:] if number]
    if tag[1] == "rocm" and len(named) == 2:
        return found == named or (named >= [7] and found < named)
    return tag[1] != "cu" or tag[2] == "".join(map(str, found))


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
