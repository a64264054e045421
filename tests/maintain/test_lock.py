"""The lock names every package that the project needs, in the version that is installed."""

import tomllib
from importlib.metadata import version

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from robo_genesis.core.project import ROOT, locked_versions

LOCK = (ROOT / "requirements.lock").read_text()
LOCKED = {canonicalize_name(name): v for name, v in locked_versions(LOCK).items()}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_the_lock_has_every_direct_dependency_as_it_is_installed():
    extras = PROJECT["optional-dependencies"].values()
    direct = [*PROJECT["dependencies"], *(line for lines in extras for line in lines)]
    for requirement in map(Requirement, direct):
        locked = LOCKED[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(locked)
        assert version(requirement.name).split("+")[0] == locked


def test_torch_is_a_range_for_users_and_the_lock_has_no_part_of_a_build():
    (torch,) = (
        Requirement(line)
        for line in PROJECT["dependencies"]
        if line.startswith("torch")
    )
    assert not any(spec.operator == "==" for spec in torch.specifier)
    assert "+" not in LOCK
    assert not {name for name in LOCKED if name.startswith("nvidia-cudnn")}
