"""`make evidence-rocm`: the command of the container, and what it says where none can start."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.pipeline.recording import rocm_container
from robo_genesis.pipeline.recording.rocm_container import Host, commands, record

DOCKERFILE = (ROOT / rocm_container.DOCKERFILE).read_text()
NULL = Path(os.devnull)


def host(found: str = "docker", devices=(NULL,), **environment: str) -> Host:
    given = {"LESSON": "l04"} | environment
    return Host(Path("/a checkout"), {found: f"/usr/bin/{found}"}.get, given, devices)


def options(command: list[str], name: str) -> list[str]:
    return [word.partition("=")[2] for word in command if word.startswith(f"{name}=")]


@pytest.mark.parametrize("engine", ["docker", "podman"])
def test_the_container_gets_the_devices_their_groups_the_user_and_the_checkout(engine):
    build, run = commands(
        host(engine, HIP_VISIBLE_DEVICES="0", SECRET="s", ROCM_PATH="/here")
    )
    assert build == [
        engine,
        "build",
        "--tag",
        run[-5],
        "--file",
        ".rocm/Dockerfile",
        ".",
    ]
    assert run[-4:] == ["make", "evidence", "BACKEND=amdgpu", "PYTHON=python"]
    assert f"--device={NULL}" in run
    assert options(run, "--security-opt") == ["seccomp=unconfined"]
    assert options(run, "--volume") == ["/a checkout:/course"]
    given = ["HOME=/tmp", "USER=course", "HIP_VISIBLE_DEVICES", "LESSON"]
    assert options(run, "--env") == given
    of_user = {
        name: options(run, name) for name in ("--group-add", "--user", "--userns")
    }
    user = [f"{os.getuid()}:{os.getgid()}"]
    docker = {"--group-add": [str(NULL.stat().st_gid)], "--user": user, "--userns": []}
    podman = {"--group-add": ["keep-groups"], "--user": [], "--userns": ["keep-id"]}
    assert of_user == {"docker": docker, "podman": podman}[engine]


def test_a_missing_device_is_named_with_the_remedy():
    with pytest.raises(
        ProjectError, match=r"/dev/no-gpu is missing here\. A recording "
    ):
        commands(host(devices=(NULL, Path("/dev/no-gpu"))))


def test_a_host_without_packages_gets_the_message(tmp_path):
    """`-I -S` hides all packages, and an empty PATH docker and podman."""
    script = ROOT / "build_scripts" / "evidence_rocm.py"
    start = f"import sys, runpy; sys.path.insert(0, {str(ROOT)!r}); sys.argv[1:] = []; "
    code = f"{start} runpy.run_path({str(script)!r}, {{}}, '__main__')"
    given = {"PATH": str(tmp_path), "LESSON": "l04"}
    command = [sys.executable, "-I", "-S", "-c", code]
    done = subprocess.run(command, env=given, capture_output=True, text=True)
    assert done.returncode == 1
    said = "PATH has neither docker nor podman. Install one of them, or record w"
    assert done.stderr.lstrip().startswith(said), done.stderr
    assert done.stderr.endswith("FAILED: nothing was recorded.\n")


def test_a_failed_command_is_named_and_ends_the_recording(tmp_path, monkeypatch, capfd):
    stub = tmp_path / "docker"
    stub.write_text('#!/bin/sh\necho "$1"\nexit 7\n')
    stub.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    given = Host(tmp_path, {"docker": str(stub)}.get, {"LESSON": "l04"}, (NULL,))
    assert record(given) == 7
    out, err = capfd.readouterr()
    assert out == "build\n"
    assert err.startswith("FAILED with status 7: docker build")


def test_the_image_keeps_the_torch_of_its_base():
    assert re.search(r"^FROM rocm/pytorch:\S+@sha256:[0-9a-f]{64}$", DOCKERFILE, re.M)
    assert "grep -v '^torch=='" in DOCKERFILE
    assert "--no-deps" in DOCKERFILE
    lock = (ROOT / "requirements.lock").read_text()
    assert re.search(r"^torch==", lock, re.M)
