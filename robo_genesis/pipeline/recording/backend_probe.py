"""What a run would find on this machine: a probe of seconds, before the engine starts."""

import json
import signal
import subprocess
import sys
from contextlib import suppress
from typing import Any

from robo_genesis.core.refusals import printable
from robo_genesis.pipeline.command import end_with_parent
from robo_genesis.pipeline.recording import torch_probe
from robo_genesis.pipeline.recording.probe_steps import (
    SYSTEM,
    TORCH,
    DoubtError,
    Machine,
    Step,
    Subject,
    built_for,
    torch,
)
from robo_genesis.sim.diagnosis import Finding, StepError

PROBE_SECONDS = 180.0


def probe(expected: str | None, machine: Machine | None = None) -> tuple[str, list[Finding]]:
    """Return the backend that Torch finds, and the findings of all steps.

    Args:
        expected: the accelerator to record, None for the one that Torch is built for.
        machine: by default this one.
    """
    machine = machine or Machine()
    facts, ended = _torch_facts(machine)
    built = built_for(facts)
    backend = expected or built
    subject = Subject(machine, backend, facts, ended)
    findings = [_finding(step, subject) for step in SYSTEM.get(backend, ())]
    later: list[Finding] = []
    for step in TORCH.get(backend, (torch,)):
        broken = any(finding.state == "broken" for finding in later)
        later.append(Finding(step.__name__, "not run", "") if broken else _finding(step, subject))
    return (built if facts.get("count") else "") or "cpu", findings + later


def _finding(step: Step, subject: Subject) -> Finding:
    try:
        state, found = "ok", step(subject)
    except DoubtError as doubt:
        state, found = "warning", str(doubt)
    except (StepError, OSError, ValueError) as error:
        state, found = "broken", str(error)
    return Finding(step.__name__, state, printable(found))


def _torch_facts(machine: Machine) -> tuple[dict[str, Any], str]:
    """Return the facts from Torch, and how its process ended."""
    command = [sys.executable, "-P", torch_probe.__file__, str(machine.at("/proc/self/maps"))]
    try:
        done = subprocess.run(
            command,
            env={**machine.environ},
            capture_output=True,
            timeout=PROBE_SECONDS,
            check=False,
            preexec_fn=end_with_parent(),
        )
        output, ended = done.stdout, _ended(done.returncode, done.stderr)
    except subprocess.TimeoutExpired as error:
        output, ended = error.stdout or b"", f"no answer in {PROBE_SECONDS:g} s"
    facts: dict[str, Any] = {}
    for line in output.decode("utf8", errors="replace").splitlines():
        with suppress(ValueError, TypeError):  # a driver may write lines of its own
            facts |= json.loads(line)
    return facts, facts.pop("error", ended)


def _ended(status: int, errors: bytes) -> str:
    """Return how a process ended: by a signal, or with the last line that it wrote."""
    if status < 0:
        return f"killed by {signal.Signals(-status).name}"
    lines = errors.decode("utf8", errors="replace").strip().splitlines()
    return lines[-1] if lines else f"status {status}"
