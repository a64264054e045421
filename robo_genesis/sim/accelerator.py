"""The steps of the doctor for an accelerator: what a run would find, without starting the engine.

They read files below a given root, variables, and what Torch answers in a process of
its own.
"""

import grp
import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from robo_genesis.sim import torch_probe
from robo_genesis.sim.backends import DRIVERS, driver_version
from robo_genesis.sim.diagnosis import DoubtError, StepError, StepResult, run_steps

PROBE_SECONDS = 180  # Until Torch must have answered

VISIBILITY = ("ROCR_VISIBLE_DEVICES", "HIP_VISIBLE_DEVICES", "CUDA_VISIBLE_DEVICES")

# Where the engine's compiler looks for `llvm/bin/ld.lld` after ROCM_PATH and before
# PATH.
ROCM_FOLDERS = ("opt/rocm", "opt/rocm-7.0.0", "opt/rocm-6.0.0")


@dataclass(slots=True)
class ProbedMachine:
    """Where the steps look: in these variables, and below `root`.

    `probe` adds the backend to record and the facts from Torch, whose process `ended`
    so; empty means without an error.
    """

    environ: Mapping[str, str]
    root: Path = Path("/")
    backend: str = ""
    torch: Mapping[str, Any] = field(default_factory=dict)
    ended: str = ""

    def said(self, fact: str) -> Any:
        """Return a fact from Torch; raise StepError if its process ended before."""
        if fact not in self.torch:
            raise StepError(
                f"Torch of {sys.executable} ended without an answer: {self.ended}. Repair that "
                "environment, or name another with PYTHON=path."
            )
        return self.torch[fact]


def devices(machine: ProbedMachine) -> str:
    """The device files of the driver exist, and this user may open them."""
    kfd, drawing = (
        machine.root / "dev/kfd",
        sorted((machine.root / "dev/dri").glob("renderD*")),
    )
    absent = ["/dev/kfd"] * (not kfd.exists()) + ["/dev/dri/renderD*"] * (not drawing)
    if absent:
        raise StepError(
            f"{' and '.join(absent)} missing, expected both. Load the driver: modprobe amdgpu. "
            "Start a container with --device=/dev/kfd --device=/dev/dri."
        )
    open_ = [node for node in (kfd, *drawing) if os.access(node, os.R_OK | os.W_OK)]
    names = " ".join(node.name for node in open_)
    if kfd in open_ and len(open_) > 1:
        return f"may open {names}"
    groups = sorted({_group(node.stat().st_gid) for node in (kfd, *drawing)})
    raise StepError(
        f"You may open {names or 'none of them'}, expected kfd and a renderD. They belong to "
        f"{' and '.join(groups)}; your groups are {' '.join(map(_group, os.getgroups()))}. Run "
        "usermod -aG render,video for your user and log in again; in a container, --group-add."
    )


def _group(number: int) -> str:
    """Return the name of a group, or its number in a container that does not name it."""
    try:
        return grp.getgrgid(number).gr_name
    except KeyError:
        return str(number)


def driver(machine: ProbedMachine) -> str:
    """The kernel has loaded the driver."""
    name = DRIVERS[machine.backend]
    if not (machine.root / "sys/module" / name).is_dir():
        raise DoubtError(
            f"/sys/module has no {name}, expected the driver loaded: modprobe {name}."
        )
    return f"{name} {driver_version(machine.backend, machine.root)}"


def card(machine: ProbedMachine) -> str:
    """The driver lists a card."""
    nodes = machine.root / "sys/class/kfd/kfd/topology/nodes"
    found = []
    for path in sorted(nodes.glob("*/properties")):
        lines = (line.partition(" ") for line in path.read_text("utf8").splitlines())
        number = int(
            {name: value for name, _, value in lines}.get("gfx_target_version", "0")
        )
        if number:  # 0 is a processor
            found.append(f"gfx{number // 10000}{number // 100 % 100:x}{number % 100:x}")
    if not found:
        raise StepError(
            f"{nodes} names no card, expected one with a gfx_target_version. "
            "Check with rocminfo that the driver supports the card."
        )
    return ", ".join(found)


def linker(machine: ProbedMachine) -> str:
    """`ld.lld`, with which the engine's compiler links each kernel, is where it looks."""
    given = machine.environ.get("ROCM_PATH")
    folders = ([Path(given)] if given else []) + [
        machine.root / path for path in ROCM_FOLDERS
    ]
    for file in (folder / "llvm/bin/ld.lld" for folder in folders):
        if file.is_file():
            return str(file)
    if on_path := shutil.which("ld.lld", path=machine.environ.get("PATH", "")):
        return on_path
    raise StepError(
        f"No ld.lld, expected in llvm/bin of ROCM_PATH ({given or 'unset'}) or /opt/rocm, or on "
        "PATH. A driver and Torch do not contain it: install ROCm's LLVM, or set ROCM_PATH."
    )


def visibility(machine: ProbedMachine) -> str:
    """At most the one variable is set that selects a card reliably."""
    environ = machine.environ
    given = {name: environ[name] for name in VISIBILITY if name in environ}
    if hiding := [name for name, value in given.items() if not value.strip()]:
        raise StepError(
            f"{' and '.join(hiding)} is set and empty, which hides every card. Unset it, or name a "
            "card."
        )
    text = ", ".join(f"{name}={value}" for name, value in given.items())
    if given.keys() <= {VISIBILITY[0]}:
        return text or "no variable hides a card"
    remedy = f"Only {VISIBILITY[0]} selects a card reliably: set it alone and unset the others."
    if (
        len(given) == len(VISIBILITY)
        and len({*given.values()}) == 1
        and "0" not in given.values()
    ):
        raise StepError(
            f"{text}: one index other than 0 in all three hides the card. {remedy}"
        )
    raise DoubtError(f"{text}. {remedy}")


def torch(machine: ProbedMachine) -> str:
    """Torch is a build for the backend."""
    version, hip, cuda = map(machine.said, ("torch", "hip", "cuda"))
    what = f"HIP {hip}" if hip else f"CUDA {cuda}" if cuda else "the CPU alone"
    if (built := built_for(machine.torch)) and built == machine.backend:
        return f"{version}, built for {what}"
    raise StepError(
        f"Torch {version} is built for {what}, expected a build for "
        f"{machine.backend or 'amdgpu or cuda'}. Name an environment with one by PYTHON=path, or "
        "record the CPU with BACKEND=cpu."
    )


def device(machine: ProbedMachine) -> str:
    """Torch finds a device."""
    if (count := machine.said("count")) == 0:
        raise StepError(
            "Torch finds no device, expected one. Check driver and rights of access."
        )
    name = f"{machine.said('device')} {machine.said('gfx')}".rstrip()
    return f"{name}, device 0 of {count}"


def device_code(machine: ProbedMachine) -> str:
    """Torch contains code for the card."""
    gfx, codes = machine.said("gfx"), machine.said("codes")
    if gfx in codes:
        return f"Torch has code for {gfx}"
    text = (
        f"Torch has code for {', '.join(codes) or 'no card'}, expected {gfx}. Install Torch with "
        f"it: torch[device-{gfx}] from AMD's index."
    )
    raise (DoubtError if machine.torch.get("kernel") == torch_probe.SUM else StepError)(
        text
    )


def hip_runtime(machine: ProbedMachine) -> str:
    """The engine's compiler opens the HIP runtime that Torch has loaded, and no second one."""
    own, files, unopened = map(machine.said, ("own", "runtimes", "unopened"))
    name = torch_probe.RUNTIME
    remedy = (
        f"Link {name} in a folder to {own[0] if own else 'the copy of Torch'}, and name that "
        "folder in LD_LIBRARY_PATH, as AMD's Dockerfile for Genesis does."
    )
    if unopened:
        raise StepError(
            f"{name}, which the engine opens, cannot be loaded: {unopened}. {remedy}"
        )
    if len(files) > 1:
        raise DoubtError(
            f"{len(files)} are loaded: {', '.join(files)}; expected Torch's. {remedy}"
        )
    return ", ".join(files)


def kernel(machine: ProbedMachine) -> str:
    """The card computes."""
    found, expected = machine.said("kernel"), torch_probe.SUM
    if found != expected:
        raise StepError(
            f"A sum on the card is {found}, expected {expected}. Check the driver."
        )
    return f"a sum on the card is {found}, as expected"


def built_for(facts: Mapping[str, Any]) -> str:
    """Return the accelerator that Torch is built for; ROCm and CUDA both call theirs `cuda`."""
    return "amdgpu" if facts.get("hip") else "cuda" if facts.get("cuda") else ""


# The steps for each accelerator; a broken one ends its own chain.
CHAINS: dict[str, tuple[tuple[Callable[[ProbedMachine], str], ...], ...]] = {
    "amdgpu": (
        (devices,),
        (driver,),
        (card,),
        (linker,),
        (visibility,),
        (torch, device, device_code, hip_runtime, kernel),
    ),
    "cuda": ((driver,), (torch, device, kernel)),
}


def probe(machine: ProbedMachine, expected: str | None) -> tuple[str, list[StepResult]]:
    """Return the backend that Torch finds, and the results of all steps.

    Args:
        machine: the one to look at.
        expected: the accelerator to record, None for the one that Torch is built for.
    """
    machine.torch, machine.ended = torch_facts(machine)
    built = built_for(machine.torch)
    machine.backend = expected or built
    chains = CHAINS.get(machine.backend, ((torch,),))
    results = [result for chain in chains for result in run_steps(chain, machine)]
    return (built if machine.torch.get("count") else "") or "cpu", results


def torch_facts(machine: ProbedMachine) -> tuple[dict[str, Any], str]:
    """Return the facts from Torch, and how its process ended."""
    maps = machine.root / "proc/self/maps"
    command = [
        sys.executable,
        "-P",
        torch_probe.__file__,
        str(maps),
        str(PROBE_SECONDS),
    ]
    done = subprocess.run(
        command, env={**machine.environ}, capture_output=True, check=False
    )
    facts: dict[str, Any] = {}
    for line in done.stdout.decode("utf8", errors="replace").splitlines():
        with suppress(ValueError, TypeError):  # a driver may write lines of its own
            facts |= json.loads(line)
    return facts, facts.pop("error", _ended(done.returncode, done.stderr))


def _ended(status: int, errors: bytes) -> str:
    """Return how a process ended: by a signal, or with the last line that it wrote."""
    if status == -signal.SIGALRM:
        return f"no answer in {PROBE_SECONDS} s"
    if status < 0:
        return f"killed by {signal.Signals(-status).name}"
    lines = errors.decode("utf8", errors="replace").strip().splitlines()
    return lines[-1] if lines else f"status {status}"
