"""What Quadrants and Torch report fits one backend, or is a contradiction."""

from itertools import product
from types import SimpleNamespace

import pytest

from robo_genesis.sim.backends import BACKENDS, contradictions

# Versions of HIP and CUDA for which Torch was built.
BUILDS = ((None, None), ("6.4", None), (None, "12.8"), ("6.4", "12.8"))


def agrees(actual, arch, device, build, torch="2.13.0"):
    hip, cuda = build
    reported = {"torch_version": torch, "torch_device": device}
    reported |= {"hip_version": hip, "cuda_version": cuda}
    return not any(
        contradictions(SimpleNamespace(actual=actual, arch=arch, **reported))
    )


def test_one_backend_throughout_is_accepted_and_nothing_else():
    archs = ("x64", "arm64", "cuda", "amdgpu", "metal", "vulkan")
    every = product(BACKENDS, archs, ("cpu", "cuda", "mps"), BUILDS)
    assert {given for given in every if agrees(*given)} == {
        *product(["cpu"], ["x64", "arm64"], ["cpu"], BUILDS),
        *product(["metal"], ["metal"], ["mps"], BUILDS),
        ("cuda", "cuda", "cuda", (None, "12.8")),
        ("amdgpu", "amdgpu", "cuda", ("6.4", None)),
    }


@pytest.mark.parametrize(
    ("torch", "hip", "agreed"),
    [
        ("2.6.0+rocm6.4.1.git1ded221d", "6.4.43483-a187df25c", True),
        ("2.9.1+rocm7.2.1", "7.2.53211-e1a6bc5663", True),
        (
            "2.13.0+rocm10.0.0",
            "7.14.60850",
            True,
        ),  # HIP has a version of its own since ROCm 7
        ("2.10.0a0+rocmsdk20251118", "7.2.0", True),
        ("2.13.0+rocm6.4", "6.3.42131", False),
        ("2.13.0+rocm7.1", "7.2.0", False),
        ("2.13.0+cpu", "7.1.0", False),
        ("2.13.0+cu130", "13.0", False),
    ],
)
def test_the_tag_of_torch_fits_its_hip(torch, hip, agreed):
    assert agrees("amdgpu", "amdgpu", "cuda", (hip, None), torch) is agreed
