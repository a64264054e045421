"""`make evidence-rocm`: the command of the container, and what it says where none can start."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from robo_genesis.core.project import BOOK, ROOT, ProjectError
from robo_genesis.pipeline.recording import rocm_container
from robo_genesis.pipeline.recording.rocm_container import record, run_command

NULL = Path(os.devnull)


@pytest.fixture(autouse=True)
def devices(monkeypatch):
    monkeypatch.setattr(rocm_container, "DEVICES", (NULL,))


def test_the_page_names_the_versions_in_the_image():
    (image,) = re.findall(r"FROM (\S+)", (ROOT / rocm_container.DOCKERFILE).read_text())
    named = re.findall(r":rocm([\d.]+)_.*_py([\d.]+)_.*_release_([\d.]+)@", image)
    page = (BOOK / "evidence/recording.md").read_text()
    for name, version in zip(("ROCm", "Python", "PyTorch"), *named, strict=True):
        assert f"{{literal}}`{name} {version}`" in page


def options(command: list[str], name: str) -> list[str]:
    return [word.partition("=")[2] for word in command if word.startswith(f"{name}=")]


@pytest.mark.parametrize("engine", ["docker", "podman"])
def test_the_container_gets_the_devices_their_groups_the_user_and_the_checkout(
    engine, monkeypatch
):
    given = {"HIP_VISIBLE_DEVICES": "0", "SECRET": "s", "ROCM_PATH": "/here"}
    monkeypatch.setattr(os, "environ", given)
    run = run_command(f"/usr/bin/{engine}", "l04")
    made = ["make", "evidence", "BACKEND=amdgpu", "PYTHON=python", "LESSON=l04"]
    assert run[-6:] == ["robo-genesis-rocm", *made]
    assert f"--device={NULL}" in run
    assert options(run, "--volume") == [f"{ROOT}:/course"]
    assert options(run, "--env") == ["HOME=/tmp", "USER=course", "HIP_VISIBLE_DEVICES"]
    of_user = {
        name: options(run, name) for name in ("--group-add", "--user", "--userns")
    }
    user = [f"{os.getuid()}:{os.getgid()}"]
    docker = {"--group-add": [str(NULL.stat().st_gid)], "--user": user, "--userns": []}
    podman = {"--group-add": ["keep-groups"], "--user": [], "--userns": ["keep-id"]}
    assert of_user == {"docker": docker, "podman": podman}[engine]


def test_a_missing_device_is_named_with_the_remedy(monkeypatch):
    monkeypatch.setattr(rocm_container, "DEVICES", (NULL, Path("/dev/no-gpu")))
    monkeypatch.setattr(rocm_container.shutil, "which", lambda name: "/bin/docker")
    with pytest.raises(ProjectError, match=r"/dev/no-gpu missing here\. A recording "):
        record("")


def test_a_host_without_packages_gets_the_message(tmp_path):
    """`-I -S` hides all packages, and an empty PATH docker and podman."""
    code = (
        f"import sys; sys.path.insert(0, {str(ROOT)!r}); from robo_genesis.__main__ import main; "
        "sys.exit(main(['evidence-rocm']))"
    )
    command = [sys.executable, "-I", "-S", "-c", code]
    environment = {"PATH": str(tmp_path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.lstrip().startswith("PATH has neither docker nor podman.")


def test_a_failed_build_of_the_image_ends_the_recording(tmp_path, monkeypatch, capfd):
    stub = tmp_path / "docker"
    stub.write_text('#!/bin/sh\necho "$1"\nexit 7\n')
    stub.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    assert record("l04") == 7
    assert capfd.readouterr().out == "build\n"
