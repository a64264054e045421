"""Which version may take the pin's place, and the one line that is written."""

import subprocess
from types import SimpleNamespace

import pytest

from robo_genesis.core import project
from robo_genesis.core.project import ProjectError
from robo_genesis.maintain.pin import RepinError, chosen_version, installable_versions, set_pin

KNOWN = ["1.4.5", "1.4.0", "1.3.3", "2.0.0rc1"]


@pytest.mark.parametrize(
    ("given", "found", "prereleases"),
    [
        ("1.4", "1.4.0", False),
        ("v1.4.0", "1.4.0", False),
        ("2.0.0rc1", "2.0.0rc1", True),
    ],
)
def test_a_version_is_spelled_as_the_index_spells_it(given, found, prereleases):
    asked = []
    assert chosen_version(given, "1.3.3", lambda pre: asked.append(pre) or KNOWN) == found
    assert asked == [prereleases]


def answer(monkeypatch, **done):
    values = {"returncode": 0, "stdout": "", "stderr": ""} | done
    commands = []

    def run(command, **options):
        commands.append(command)
        return SimpleNamespace(**values)

    monkeypatch.setattr(subprocess, "run", run)
    return commands


def test_pip_is_asked_for_the_versions(monkeypatch):
    out = "genesis-world (1.4.5)\nAvailable versions: 1.4.5, 1.4.4\n  INSTALLED: 1.3.3\n"
    commands = answer(monkeypatch, stdout=out)
    assert installable_versions(False) == ["1.4.5", "1.4.4"]
    installable_versions(True)
    assert [command[-1] for command in commands] == ["genesis-world", "--pre"]


@pytest.mark.parametrize("done", [{"returncode": 1, "stderr": "no route"}, {"stdout": "other"}])
def test_without_an_answer_the_network_is_named(monkeypatch, done):
    answer(monkeypatch, **done)
    with pytest.raises(RepinError, match=r"cannot list the versions.*\n.*needs the network"):
        installable_versions(False)


def project_file(folder, line: str):
    (folder / "pyproject.toml").write_text(f"[project]\n# genesis-world==1.3.3 here\n{line}\n")
    return folder


@pytest.mark.parametrize("pinned", ["genesis-world==1.3.3", "genesis-world == 1.3.3"])
def test_only_the_pin_is_rewritten(tmp_path, pinned):
    root = project_file(tmp_path, f'dependencies = ["a>=1", "{pinned}"] # why')
    set_pin(root, "1.3.3", "1.4.5")
    assert project.engine_pin(root) == "1.4.5"
    assert (root / "pyproject.toml").read_text() == (
        "[project]\n# genesis-world==1.3.3 here\n"
        'dependencies = ["a>=1", "genesis-world==1.4.5"] # why\n'
    )


@pytest.mark.parametrize("lines", ['"genesis-world==1.3.30"', '"genesis-world==1.3.3", ' * 2])
def test_a_pin_that_does_not_stand_there_once_is_not_touched(tmp_path, lines):
    root = project_file(tmp_path, f"dependencies = [{lines}]")
    text = (root / "pyproject.toml").read_text()
    with pytest.raises(ProjectError, match=r"expected once"):
        set_pin(root, "1.3.3", "1.4.5")
    assert (root / "pyproject.toml").read_text() == text
