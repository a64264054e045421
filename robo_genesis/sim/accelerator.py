"""The steps of the doctor for an accelerator: what a run would find, without starting the engine.

They read files below a given root, variables, and what Torch answers in a process of
its own.
"""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from robo_genesis.core.text import ended

from . import torch_probe
from .diagnosis import StepError, StepResult, run_steps

PROBE_SECONDS = 180  # Until Torch must have answered

# Where the engine's compiler looks for `llvm/bin/ld.lld` after ROCM_PATH and before
# PATH.
ROCM_FOLDERS = ("opt/rocm", "opt/rocm-7.0.0", "opt/rocm-6.0.0")


@dataclass(slots=True)
class ProbedMachine:
    """Where the steps look: in these variables, and below `root`.

    `probe` adds the backend to record and the facts from Torch, and how its process
    ended.
    """

    environ: Mapping[str, str]
    root: Path = Path("/")
    backend: str = ""
    facts: Mapping[str, Any] = field(default_factory=dict)
    ending: str = ""

    def fact(self, name: str) -> Any:
        """Return a fact from Torch; raise StepError if its process ended before."""
        if name not in self.facts:
            raise StepError(
                f"Torch of {sys.executable} ended without an answer: {self.ending}. Repair that "
                "environment, or name another with PYTHON=path."
            )
        return self.facts[name]


def devices(machine: ProbedMachine) -> str:
    """The device files of the driver exist, and this user may open them."""
    kfd = machine.root / "dev/kfd"
    nodes = [kfd, *sorted((machine.root / "dev/dri").glob("renderD*"))]
    opened = [node for node in nodes if os.access(node, os.R_OK | os.W_OK)]
    names = " ".join(node.name for node in opened)
    if kfd in opened and len(opened) > 1:
        return f"may open {names}"
    raise StepError(
        f"You may open {names or 'nothing'}, expected /dev/kfd and a /dev/dri/renderD*. If they "
        "are missing, run modprobe amdgpu, or start the container with --device=/dev/kfd "
        "--device=/dev/dri. Otherwise run usermod -aG render,video for your user and log in "
        "again; in a container, --group-add."
    )


def linker(machine: ProbedMachine) -> str:
    """`ld.lld`, with which the engine's compiler links each kernel, is where it looks."""
    given = machine.environ.get("ROCM_PATH")
    folders = [Path(given)] if given else []
    folders += [machine.root / path for path in ROCM_FOLDERS]
    for file in (folder / "llvm/bin/ld.lld" for folder in folders):
        if file.is_file():
            return str(file)
    if on_path := shutil.which("ld.lld", path=machine.environ.get("PATH", "")):
        return on_path
    raise StepError(
        f"No ld.lld, expected in llvm/bin of ROCM_PATH ({given or 'unset'}) or /opt/rocm, or on "
        "PATH. A driver and Torch do not contain it: install ROCm's LLVM, or set ROCM_PATH."
    )


def torch(machine: ProbedMachine) -> str:
    """Torch is a build for the backend."""
    version, hip, cuda = map(machine.fact, ("torch", "hip", "cuda"))
    build = f"HIP {hip}" if hip else f"CUDA {cuda}" if cuda else "the CPU alone"
    if machine.backend and built_for(machine.facts) == machine.backend:
        return f"{version}, built for {build}"
    raise StepError(
        f"Torch {version} is built for {build}, expected a build for "
        f"{machine.backend or 'amdgpu or cuda'}. Name an environment with one by PYTHON=path, or "
        "record the CPU with BACKEND=cpu."
    )


def device(machine: ProbedMachine) -> str:
    """Torch finds a device."""
    if (count := machine.fact("count")) == 0:
        raise StepError(
            "Torch finds no device, expected one. Check driver, rights of access, and the "
            "variables that hide cards: {ROCR,HIP,CUDA}_VISIBLE_DEVICES."
        )
    name = f"{machine.fact('device')} {machine.fact('gfx')}".rstrip()
    return f"{name}, device 0 of {count}"


def hip_runtime(machine: ProbedMachine) -> str:
    """The HIP runtime can be loaded by the name that the engine's compiler opens."""
    name = torch_probe.RUNTIME
    if unopened := machine.fact("unopened"):
        raise StepError(
            f"{name}, which the engine opens, cannot be loaded: {unopened}. Link {name} in a "
            "folder to the copy of Torch, and name that folder in LD_LIBRARY_PATH, as AMD's "
            "Dockerfile for Genesis does."
        )
    return f"{name} can be loaded"


def kernel(machine: ProbedMachine) -> str:
    """The card computes."""
    total, expected = machine.fact("kernel"), torch_probe.SUM
    if total != expected:
        raise StepError(
            f"A sum on the card is {total}, expected {expected}. Check the driver."
        )
    return f"a sum on the card is {total}, as expected"


def built_for(facts: Mapping[str, Any]) -> str:
    """Return the accelerator that Torch is built for; ROCm and CUDA both call theirs `cuda`."""
    return "amdgpu" if facts.get("hip") else "cuda" if facts.get("cuda") else ""


# The steps for each accelerator; a broken one ends its own chain.
CHAINS = {
    "amdgpu": [[devices], [linker], [torch, device, hip_runtime, kernel]],
    "cuda": [[torch, device, kernel]],
}


def probe(machine: ProbedMachine, expected: str | None) -> tuple[str, list[StepResult]]:
    """Return the backend that Torch finds, and the results of all steps.

    Args:
        machine: the one to look at.
        expected: the accelerator to record, None for the one that Torch is built for.
    """
    machine.facts, machine.ending = torch_facts(machine)
    built = built_for(machine.facts)
    machine.backend = expected or built
    chains = CHAINS.get(machine.backend, [[torch]])
    results = [result for chain in chains for result in run_steps(chain, machine)]
    return (built if machine.facts.get("count") else "") or "cpu", results


def torch_facts(machine: ProbedMachine) -> tuple[dict[str, Any], str]:
    """Return the facts from Torch, and how its process ended."""
    command = [sys.executable, "-P", torch_probe.__file__]
    try:
        done = subprocess.run(
            command, env=machine.environ, capture_output=True, timeout=PROBE_SECONDS
        )
        output, errors = done.stdout, done.stderr.decode("utf8", "replace").split("\n")
        ending = " ".join([ended(done.returncode), *errors[-2:]]).strip()
    except subprocess.TimeoutExpired as error:
        output, ending = error.stdout or b"", f"no answer in {PROBE_SECONDS} s"
    facts: dict[str, Any] = {}
    for line in output.decode("utf8", "replace").splitlines():
        with suppress(ValueError, TypeError):  # a driver may write lines of its own
            facts |= json.loads(line)
    return facts, ending
