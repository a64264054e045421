"""The lock names every package that the project needs, in the version that is installed."""

import importlib.metadata
import tomllib

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from robo_genesis.core.project import ROOT
from robo_genesis.maintain import lock

LINES = [
    line
    for line in (ROOT / "requirements.lock").read_text().splitlines()
    if line[:1] != "#"
]
LOCKED = {canonicalize_name(n): v for n, v in (line.split("==") for line in LINES)}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_what_the_project_does_not_need_and_parts_of_torch_s_cuda_build_are_left_out():
    packages = {
        "robo-genesis": {
            "requires_dist": ["torch>=2", "engine[fast]", 'tester; extra == "dev"']
        },
        "engine": {
            "requires_dist": [
                "nvidia-nvrtc-cu12; platform_system == 'Linux'",
                'old-helper; python_version < "3"',
                'quick; extra == "fast"',
                'other; extra == "slow"',
            ]
        },
        "torch": {
            "requires_dist": ["sympy", "cuda-toolkit[all]==13", "nvidia-nvrtc-cu12"]
        },
        "cuda-toolkit": {"requires_dist": ["nvidia-cublas"]},
        "stranger": {"requires_dist": ["engine"]},
        **{
            n: {}
            for n in (
                "sympy",
                "nvidia-nvrtc-cu12",
                "tester",
                "old-helper",
                "quick",
                "other",
            )
        },
    }
    used = {"torch", "engine", "sympy", "nvidia-nvrtc-cu12", "quick", "tester"}
    assert lock.needed(packages) == used


def test_the_lock_is_what_is_needed_of_what_is_installed():
    """A resolution which keeps the installed packages leaves the lock unchanged."""
    distributions = importlib.metadata.distributions()
    installed = {canonicalize_name(d.name): d.metadata.json for d in distributions}
    extras = PROJECT["optional-dependencies"].values()
    direct = [*PROJECT["dependencies"], *(line for lines in extras for line in lines)]
    found = lock.needed(installed | {"robo-genesis": {"requires_dist": direct}})
    versions = {name: installed[name]["version"].split("+")[0] for name in found}
    assert versions == LOCKED
    asked = [Requirement(line) for line in direct]
    here = {
        canonicalize_name(r.name) for r in asked if not r.marker or r.marker.evaluate()
    }
    assert here <= LOCKED.keys()


def test_the_lock_is_written_whole_and_torch_stays(tmp_path, monkeypatch):
    packages = {
        "robo-genesis": {"requires_dist": ["genesis-world==2.0"]},
        "genesis-world": {"name": "genesis-world", "version": "2.0+local"},
    }
    asked = []
    monkeypatch.setattr(lock, "resolve", lambda *given: asked.append(given) or packages)
    monkeypatch.setattr(lock, "LOCK", tmp_path / "requirements.lock")
    lock.LOCK.write_text("torch==1.0\n")
    assert (
        lock.write_lock(["a==1"]) == "requirements.lock: 1 packages, genesis-world 2.0"
    )
    assert lock.LOCK.read_text() == f"{lock.HEADER}genesis-world==2.0\n"
    lock.write_lock(["torch==2.0"], keep=True)
    assert asked == [(["a==1", "torch==1.0"], False), (["torch==2.0"], True)]


def test_torch_is_a_range_for_users():
    assert len(LOCKED) == len(LINES)
    (torch,) = (
        Requirement(r) for r in PROJECT["dependencies"] if r.startswith("torch")
    )
    assert not any(spec.operator == "==" for spec in torch.specifier)
    assert torch.specifier.contains(LOCKED["torch"])
