"""What Quadrants and Torch report fits one backend, or is a contradiction."""

from itertools import product
from types import SimpleNamespace

from robo_genesis.sim.backends import BACKENDS, contradictions

# Versions of HIP and CUDA for which Torch was built.
BUILDS = ((None, None), ("6.4", None), (None, "12.8"), ("6.4", "12.8"))


def agrees(actual, arch, device, build):
    reported = dict(zip(("hip_version", "cuda_version"), build, strict=True))
    reported |= {"actual": actual, "arch": arch, "torch_device": device}
    return not any(contradictions(SimpleNamespace(**reported)))


def test_one_backend_throughout_is_accepted_and_nothing_else():
    archs = ("x64", "arm64", "cuda", "amdgpu", "metal", "vulkan")
    every = product(BACKENDS, archs, ("cpu", "cuda", "mps"), BUILDS)
    assert {given for given in every if agrees(*given)} == {
        *product(["cpu"], ["x64", "arm64"], ["cpu"], BUILDS),
        *product(["metal"], ["metal"], ["mps"], BUILDS),
        ("cuda", "cuda", "cuda", (None, "12.8")),
        ("amdgpu", "amdgpu", "cuda", ("6.4", None)),
    }
