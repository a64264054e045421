"""The probe on machines that are folders: device files, /sys, /proc and a Torch of a few lines."""

import ctypes.util
import json
import sys
from pathlib import Path
from unittest.mock import patch

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
    get_arch_list=lambda: told["codes"],
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
    "codes": ["gfx942"],
    "kernel": "",
    "numbers": None,
}
CUDA = {"version": "2.13.0+cu130", "hip": None, "cuda": "13.0"}
CPU = {"version": "2.13.0+cpu", "hip": None, "count": 0}
LLD = "opt/rocm/llvm/bin/ld.lld"
OWN, OTHER = "/env/torch/lib/libamdhip64.so", "/opt/rocm/lib/libamdhip64.so.7.2"


class Synthetic:
    """A machine with one MI300X, on which all is well until a test changes it."""

    def __init__(self, root: Path):
        self.root, self.closed = root, ()
        self.environ = {
            "PATH": "",
            "PYTHONPATH": str(root),
            "LD_LIBRARY_PATH": str(root / "lib"),
        }
        for path in ("dev/kfd", "dev/dri/renderD128", LLD):
            self.write(path, "")
        self.write("sys/module/amdgpu/version", "6.16\n")
        self.loaded(OWN)
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

    def loaded(self, *files: str) -> None:
        lines = [
            f"7f00-7f01 r-xp 00000000 08:01 {n} {file}\n"
            for n, file in enumerate(files)
        ]
        self.write(
            "proc/self/maps",
            "".join(["7f00-7f01 rw-p 00000000 00:00 0 \n", *lines * 2]),
        )

    def removed(self, *paths: str) -> None:
        for path in paths:
            (self.root / path).unlink()

    def variables(self, value: str, *names: str) -> None:
        self.environ |= {f"{name}_VISIBLE_DEVICES": value for name in names}

    def close(self, *names: str) -> None:
        self.closed = names

    def probe(
        self, expected: str | None = "amdgpu"
    ) -> tuple[str, dict[str, str], dict[str, str]]:
        """Return the backend that is found, and state and words by step."""
        with patch("os.access", lambda path, mode: Path(path).name not in self.closed):
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
    assert found["hip_runtime"] == OWN


M, EVERY = Synthetic, ("ROCR", "HIP", "CUDA")
CRASH = {"kernel": "os.kill(os.getpid(), 11)"}
NO_CODE = "for gfx1100, expected gfx942. If the sum below fails, install Torch with it"


FAULTS = [
    (M.removed, ["dev/kfd"], "devices", "broken", "Load the driver"),
    (M.removed, ["dev/dri/renderD128"], "devices", "broken", "Load the driver"),
    (M.close, ["kfd"], "devices", "broken", "open renderD128, expected kfd and a renderD"),
    (M.close, ["renderD128"], "devices", "broken", "usermod -aG render,video"),
    (M.removed, ["sys/module/amdgpu/version"], "driver", "ok", "amdgpu of the kernel "),
    (M.removed, [LLD], "linker", "broken", "in llvm/bin of ROCM_PATH (unset)"),
    (M.variables, ["1", "ROCR"], "visibility", "ok", "ROCR_VISIBLE_DEVICES=1"),
    (M.variables, ["1", "HIP"], "visibility", "warning", "set it alone"),
    (M.variables, ["", "HIP"], "visibility", "broken", "an empty one hides every card"),
    (M.variables, ["1", *EVERY], "visibility", "warning", "all three with an index but 0"),
    (M.told, CUDA, "torch", "broken", "for CUDA 13.0, expected a build for amdgpu"),
    (M.told, {"count": 0}, "device", "broken", "Torch finds no device, expected one."),
    (M.told, {"codes": ["gfx1100"]}, "device_code", "warning", NO_CODE),
    (M.loaded, [OWN, OTHER], "hip_runtime", "warning", f"{OTHER} are loaded; expected Torch's"),
    (M.removed, [f"lib/{RUNTIME}"], "hip_runtime", "broken", "opens, cannot be loaded"),
    (M.told, CRASH, "kernel", "broken", "an answer: SIGSEGV"),
    (M.told, {"numbers": [1, 2, 3]}, "kernel", "broken", "is 14, expected 140"),
]  # fmt: skip


@pytest.mark.parametrize(("change", "given", "step", "state", "words"), FAULTS)
def test_one_thing_that_is_wrong_is_named_with_the_fix(
    machine, change, given, step, state, words
):
    change(machine, **given) if isinstance(given, dict) else change(machine, *given)
    _, states, found = machine.probe()
    assert words in found[step]
    steps = [*states]
    own = steps[steps.index("torch") :]
    later = own[own.index(step) + 1 :] if state == "broken" and step in own else []
    others = {name: "not run" if name in later else "ok" for name in steps}
    assert states == others | {step: state}  # a step of Torch ends those after it


@pytest.mark.parametrize(
    ("expected", "loaded", "state", "driver"),
    [
        (None, True, "ok", "nvidia 580.1"),
        ("cuda", False, "warning", "modprobe nvidia."),
    ],
)
def test_a_cuda_machine_is_fine_with_a_named_driver(
    machine, expected, loaded, state, driver
):
    machine.told(**CUDA)
    if loaded:
        machine.write("sys/module/nvidia/version", "580.1\n")
    backend, states, found = machine.probe(expected)
    assert backend == "cuda"
    assert states == {"driver": state, "torch": "ok", "device": "ok", "kernel": "ok"}
    assert found["driver"].endswith(driver)
    assert (found["torch"], found["device"]) == (
        "2.13.0+cu130, built for CUDA 13.0",
        "a card, device 0 of 1",
    )


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
    assert [*states.values()] == ["ok"] * 4 + ["broken"] + ["not run"] * 4
    assert f"Torch of {sys.executable} ended without an answer: " in found["torch"]
    assert said in found["torch"]
