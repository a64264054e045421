"""The lock names every package that the project needs, in the version that is installed."""

import importlib.metadata
import importlib.util
import re
import runpy
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from robo_genesis.core.project import ROOT, engine_pin

LINES = [line for line in (ROOT / "requirements.lock").read_text().splitlines() if line[:1] != "#"]
LOCKED = {canonicalize_name(n): v for n, v in (line.split("==") for line in LINES)}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
TORCH_BUILD = re.compile(r"(nvidia|cuda|triton)")
"""A build of Torch names the exact versions of its own parts; the lock leaves them to it."""


def needed(requirements: list[str], extras: set[str], seen: dict[str, str]) -> dict[str, str]:
    for line in requirements:
        requirement = Requirement(line)
        active = [{"extra": extra} for extra in extras or {""}]
        if requirement.marker and not any(requirement.marker.evaluate(env) for env in active):
            continue
        name = canonicalize_name(requirement.name)
        if name in seen:
            continue
        found = importlib.metadata.distribution(name)
        seen[name] = found.version.split("+")[0]
        below = [r for r in found.requires or [] if name != "torch" or not TORCH_BUILD.match(r)]
        needed(below, set(requirement.extras), seen)
    return seen


def test_parts_of_torch_s_cuda_build_are_left_out_unless_others_need_them():
    script = runpy.run_path(str(ROOT / "build_scripts" / "lock.py"))
    packages = {
        "robo-genesis": {"requires_dist": ["torch>=2", "engine==1"]},
        "engine": {"requires_dist": ["nvidia-nvrtc-cu12; platform_system == 'Linux'"]},
        "torch": {"requires_dist": ["sympy", "cuda-toolkit[all]==13", "nvidia-nvrtc-cu12"]},
        "cuda-toolkit": {"requires_dist": ["nvidia-cublas"]},
        **{key: {} for key in ("sympy", "nvidia-nvrtc-cu12", "nvidia-cublas")},
    }
    assert script["needed"](packages) == {"torch", "engine", "sympy", "nvidia-nvrtc-cu12"}


def test_what_the_project_does_not_need_is_left_out():
    script = runpy.run_path(str(ROOT / "build_scripts" / "lock.py"))
    packages = {
        "robo-genesis": {"requires_dist": ["engine[fast]==1", 'tester; extra == "dev"']},
        "engine": {
            "requires_dist": [
                'old-helper; python_version < "3"',
                'quick; extra == "fast"',
                'unasked; extra == "slow"',
            ]
        },
        "stranger": {"requires_dist": ["engine"]},
        **{key: {} for key in ("tester", "old-helper", "quick", "unasked")},
    }
    assert script["needed"](packages) == {"engine", "quick", "tester"}


def test_the_lock_is_what_is_needed_of_what_is_installed():
    """So that a resolution which keeps what is installed leaves the lock as it is."""
    script = runpy.run_path(str(ROOT / "build_scripts" / "lock.py"))
    installed = {
        canonicalize_name(d.name): d.metadata.json for d in importlib.metadata.distributions()
    }
    extras = PROJECT["optional-dependencies"].values()
    direct = [*PROJECT["dependencies"], *(line for lines in extras for line in lines)]
    found = script["needed"](installed | {"robo-genesis": {"requires_dist": direct}})
    assert found == LOCKED.keys()


@pytest.fixture
def script(tmp_path, monkeypatch):
    """The script with a lock of its own that knows one package; what pip says is made up."""
    spec = importlib.util.spec_from_file_location("lock", ROOT / "build_scripts" / "lock.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    packages = {
        "robo-genesis": {"requires_dist": ["genesis-world==2.0"]},
        "genesis-world": {"name": "genesis-world", "version": "2.0"},
    }
    monkeypatch.setattr(script, "resolve", lambda constraints, keep: packages)
    monkeypatch.setattr(script, "LOCK", tmp_path / "requirements.lock")
    monkeypatch.setattr(sys, "argv", ["lock.py"])
    script.LOCK.write_text("the old lock\n")
    script.LOCK.chmod(0o640)
    return script


def test_the_lock_is_written_whole_with_its_mode(script):
    assert script.main() == 0
    assert script.LOCK.read_text() == f"{script.HEADER}genesis-world==2.0\n"
    assert script.LOCK.stat().st_mode & 0o777 == 0o640
    assert [path.name for path in script.LOCK.parent.iterdir()] == [script.LOCK.name]


def test_a_lock_that_cannot_be_written_whole_leaves_the_old_one(script, monkeypatch):
    def breaks_off(path: Path, text: str) -> None:
        with path.open("w") as file:
            file.write(text[:9])
        raise OSError("no space")

    monkeypatch.setattr(Path, "write_text", breaks_off)
    with pytest.raises(OSError, match="no space"):
        script.main()
    assert script.LOCK.read_text() == "the old lock\n"
    assert [path.name for path in script.LOCK.parent.iterdir()] == [script.LOCK.name]


def test_every_line_names_one_exact_public_version():
    assert len(LOCKED) == len(LINES)
    assert all(re.fullmatch(r"[\w.]+", version) for version in LOCKED.values())


def test_the_lock_follows_the_pin():
    assert LOCKED["genesis-world"] == engine_pin()


def test_installed_closure_of_the_project_is_locked():
    extras = PROJECT["optional-dependencies"].values()
    direct = [*PROJECT["dependencies"], *(line for lines in extras for line in lines)]
    found = needed(direct, set(), {})
    assert {name: LOCKED.get(name) for name in found} == found


def test_torch_is_a_range_for_users_and_one_version_in_the_lock():
    (torch,) = (Requirement(r) for r in PROJECT["dependencies"] if r.startswith("torch"))
    assert not any(spec.operator == "==" for spec in torch.specifier)
    assert torch.specifier.contains(LOCKED["torch"])
