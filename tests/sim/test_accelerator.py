"""The probe on machines that are folders: device files and a Torch of a few lines."""

import ctypes.util
import json
import sys
from pathlib import Path

import pytest

from robo_genesis.sim import accelerator
from robo_genesis.sim.accelerator import ProbedMachine, probe
from robo_genesis.sim.torch_probe import RUNTIME

TORCH = """
import json, os, pathlib, types
told = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text())
__version__ = told["version"]
version = types.SimpleNamespace(hip=told["hip"], cuda=told["cuda"])
cuda = types.SimpleNamespace(
    device_count=lambda: told["count"],
    get_device_properties=lambda index: types.SimpleNamespace(
        name="a card", gcnArchName="gfx942:sramecc+:xnack-"),
)
print("a warning of the driver\\n{another}\\n3")

class arange(list):
    def __init__(self, count, device):
        assert device == "cuda"
        exec(told["kernel"])
        super().__init__(told["numbers"] or range(count))

    def __mul__(self, other):
        return arange_sum(sum(a * b for a, b in zip(self, other)))

class arange_sum(int):
    def sum(self):
        return self
"""
TOLD = {
    "version": "2.13.0+rocm7.1",
    "hip": "7.1.2",
    "cuda": None,
    "count": 1,
    "kernel": "",
    "numbers": None,
}
CUDA = {"version": "2.13.0+cu130", "hip": None, "cuda": "13.0"}
CPU = {"version": "2.13.0+cpu", "hip": None, "count": 0}
LLD = "opt/rocm/llvm/bin/ld.lld"


class Synthetic:
    """A machine with one MI300X, on which all is well until a test changes it."""

    def __init__(self, root: Path):
        self.root = root
        self.environ = {
            "PATH": "",
            "PYTHONPATH": str(root),
            "LD_LIBRARY_PATH": str(root / "lib"),
        }
        for path in ("dev/kfd", "dev/dri/renderD128", LLD):
            self.write(path, "")
        self.write("torch.py", TORCH)
        self.told()
        # Some library that the test's own process can open by the name of the runtime.
        (root / "lib").mkdir()
        (root / "lib" / RUNTIME).symlink_to(loadable())

    def write(self, path: str, text: str) -> Path:
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        return file

    def told(self, **values) -> None:
        self.write("torch.json", json.dumps(TOLD | values))

    def removed(self, *paths: str) -> None:
        for path in paths:
            (self.root / path).unlink()

    def probe(
        self, expected: str | None = "amdgpu"
    ) -> tuple[str, dict[str, str], dict[str, str]]:
        """Return the backend that is found, and state and words by step."""
        backend, steps = probe(ProbedMachine(self.environ, self.root), expected)
        return (
            backend,
            {s.step: s.state for s in steps},
            {s.step: s.found for s in steps},
        )


def loadable() -> Path:
    """Return a library of the C runtime, as a file that this process has loaded."""
    name = str(ctypes.util.find_library("m"))
    maps = Path("/proc/self/maps").read_text().splitlines()
    found = [line.split(maxsplit=5)[-1] for line in maps if line.endswith(f"/{name}")]
    return Path(found[0])


@pytest.fixture
def machine(tmp_path):
    return Synthetic(tmp_path)


@pytest.mark.parametrize("expected", ["amdgpu", None])
def test_an_amd_machine_is_fine(machine, expected):
    backend, states, found = machine.probe(expected)
    assert (backend, {*states.values()}) == ("amdgpu", {"ok"})
    assert found["device"] == "a card gfx942, device 0 of 1"
    assert found["hip_runtime"] == f"{RUNTIME} can be loaded"


M = Synthetic
CRASH = {"kernel": "os.kill(os.getpid(), 11)"}


FAULTS = [
    (M.removed, ["dev/kfd"], "devices", "open renderD128, expected /dev/kfd and"),
    (M.removed, ["dev/dri/renderD128"], "devices", "run modprobe amdgpu"),
    (M.removed, [LLD], "linker", "in llvm/bin of ROCM_PATH (unset)"),
    (M.told, CUDA, "torch", "for CUDA 13.0, expected a build for amdgpu"),
    (M.told, {"count": 0}, "device", "Torch finds no device, expected one."),
    (M.removed, [f"lib/{RUNTIME}"], "hip_runtime", "opens, cannot be loaded"),
    (M.told, CRASH, "kernel", "an answer: SIGSEGV"),
    (M.told, {"numbers": [1, 2, 3]}, "kernel", "is 14, expected 140"),
]  # fmt: skip


@pytest.mark.parametrize(("change", "given", "step", "words"), FAULTS)
def test_one_thing_that_is_wrong_is_named_with_the_fix(
    machine, change, given, step, words
):
    change(machine, **given) if isinstance(given, dict) else change(machine, *given)
    _, states, found = machine.probe()
    assert words in found[step]
    steps = [*states]
    own = steps[steps.index("torch") :]
    later = own[own.index(step) + 1 :] if step in own else []
    others = {name: "not run" if name in later else "ok" for name in steps}
    assert states == others | {step: "broken"}  # a step of Torch ends those after it


@pytest.mark.parametrize("expected", ["cuda", None])
def test_a_cuda_machine_is_fine(machine, expected):
    machine.told(**CUDA)
    backend, states, found = machine.probe(expected)
    assert backend == "cuda"
    assert states == dict.fromkeys(("torch", "device", "kernel"), "ok")
    assert found["torch"] == "2.13.0+cu130, built for CUDA 13.0"
    assert found["device"] == "a card, device 0 of 1"


@pytest.mark.parametrize(
    ("expected", "wanted"), [("cuda", "cuda"), (None, "amdgpu or cuda")]
)
def test_a_torch_for_the_cpu_alone_is_named(machine, expected, wanted):
    machine.told(**CPU)
    backend, states, found = machine.probe(expected)
    assert (backend, states["torch"]) == ("cpu", "broken")
    assert (
        f"built for the CPU alone, expected a build for {wanted}. Name"
        in found["torch"]
    )


@pytest.mark.parametrize(
    ("torch", "said"),
    [
        ("raise ImportError('libamdhip64.so')", "ImportError: libamdhip64.so"),
        ("import time; print('hangs', flush=True); time.sleep(60)", "no answer in 1 s"),
    ],
)
def test_a_torch_that_does_not_answer_is_named_with_the_fix(
    machine, monkeypatch, torch, said
):
    monkeypatch.setattr(accelerator, "PROBE_SECONDS", 1)
    machine.write("torch.py", torch)
    backend, states, found = machine.probe()
    assert backend == "cpu"
    assert [*states.values()] == ["ok"] * 2 + ["broken"] + ["not run"] * 3
    assert f"Torch of {sys.executable} ended without an answer: " in found["torch"]
    assert said in found["torch"]
